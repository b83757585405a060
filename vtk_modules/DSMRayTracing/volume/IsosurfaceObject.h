// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfaceObject_h
#define rt_IsosurfaceObject_h

#include "DSMBricks/layout/VoxelField.h"
#include "DSMRayTracing/ray/ClipRegion.h"
#include "DSMRayTracing/surface/ColorMap.h"
#include "DSMRayTracing/surface/Material.h"
#include "DSMRayTracing/volume/BlockLooks.h"

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace rt
{

class ObjectDigest;
template <class Store>
class IsosurfaceTracer;

/// Isosurfaces of one volume.
struct IsosurfaceObject
{
  template <class Store>
  using Tracer = IsosurfaceTracer<Store>;

  /// Point index space (sample (i,j,k) at (i,j,k) of the lattice) to world; affine, invertible.
  glm::dmat4 IndexToWorld{ 1.0 };
  /// Its inverse; SetIndexToWorld keeps the two together.
  glm::dmat4 WorldToIndex{ 1.0 };
  void SetIndexToWorld(const glm::dmat4& matrix)
  {
    this->IndexToWorld = matrix;
    this->WorldToIndex = glm::inverse(matrix);
  }
  std::shared_ptr<const bricks::VoxelField> Field;
  /// Ascending, finite, no duplicates.
  std::vector<double> Isovalues;
  /// One for each isovalue, times the material's; empty: 1.
  std::vector<float> Opacities;
  /// May be null: then the material's diffuse colour is used. Same lattice points as Field; of points, whose
  /// values are interpolated, or of cells.
  std::shared_ptr<const bricks::VoxelField> ColorField;
  ColorMap Colors;
  /// What ColorField holds.
  enum class Coloring
  {
    Values,       ///< for Colors
    OpaqueColors, ///< PackedColor; Colors says what is shown where there are none
    Colors        ///< the same, with opacities
  };
  Coloring ColoredBy = Coloring::Values;
  Material Surface;
  /// Of the side where values are above the isovalue; without, both sides are alike.
  std::optional<Material> BackSurface;
  /// Light passes through the side that values below the isovalue are on, or the other, and it is not seen.
  bool CullsFront = false;
  bool CullsBack = false;
  /// May be null: all of the volume looks alike.
  std::shared_ptr<const BlockLooks> Blocks;
  /// Lit by the normals of the surface that is in each cell, not by smooth ones.
  bool Flat = false;
  ClipRegion Clipping;

  /// Whether they let no light through anywhere.
  bool IsOpaque() const;
  /// GetSheetTransmittance for each isovalue. Empty where it is not the same all over a surface and on both of
  /// its sides.
  std::vector<glm::dvec3> GetSheetTransmittances() const;
  /// Whether any part of them is seen at all.
  bool IsSeen() const;
  /// All that a picture of them depends on.
  void AddTo(ObjectDigest& digest) const;

  /// What the surface is made of as it is seen from a side. Null: it is not seen.
  const Material* GetSurface(bool fromBack) const
  {
    return (fromBack ? this->CullsBack : this->CullsFront) ? nullptr
      : fromBack && this->BackSurface                      ? &*this->BackSurface
                                                           : &this->Surface;
  }

private:
  bool HasOpaqueColors() const;
};

} // namespace rt

#endif
