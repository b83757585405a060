// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfaceLook_h
#define rt_IsosurfaceLook_h

#include "DSMRayTracing/look/ColorMap.h"
#include "DSMRayTracing/look/Material.h"
#include "DSMRayTracing/surface/BlockLooks.h"

#include <memory>
#include <optional>
#include <vector>

namespace rt
{

class ObjectDigest;

/// What isosurfaces look like, whatever field they are of.
struct IsosurfaceLook
{
  /// One for each isovalue, times the material's; empty: 1.
  std::vector<float> Opacities;
  /// Of the values that color the surfaces, if there are any (IsosurfaceOf::ColorValues).
  ColorMap Colors;
  /// What these values are.
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
  /// May be null: all of the field looks alike.
  std::shared_ptr<const BlockLooks> Blocks;
  /// Lit by the normals of the surface that is in each cell, not by smooth ones.
  bool Flat = false;

  /// Whether the surfaces let no light through anywhere, but for what colors them.
  bool IsOpaque() const;
  /// Whether what colors the surfaces lets no light through anywhere. `hasHoles`: it has places without a color.
  bool HasOpaqueColors(bool hasHoles) const;
  /// Whether any part of the surfaces is seen at all.
  bool IsSeen() const;
  /// Whether all of a surface, and both of its sides, look alike, but for what colors it.
  bool IsAlikeEverywhere() const;
  /// All that a picture depends on.
  void AddTo(ObjectDigest& digest) const;

  /// What the surface is made of as it is seen from a side. Null: it is not seen.
  const Material* GetSurface(bool fromBack) const
  {
    return (fromBack ? this->CullsBack : this->CullsFront) ? nullptr
      : fromBack && this->BackSurface                      ? &*this->BackSurface
                                                           : &this->Surface;
  }
};

} // namespace rt

#endif
