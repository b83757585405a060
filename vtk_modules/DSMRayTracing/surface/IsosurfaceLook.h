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

/// Appearance of isosurfaces of any field.
struct IsosurfaceLook
{
  /// One for each isovalue, times the material's; empty: 1.
  std::vector<float> Opacities;
  /// Color map for the values that color the surfaces, if there are any
  /// (IsosurfaceOf::ColorValues).
  ColorMap Colors;
  /// Kind of these values.
  enum class Coloring
  {
    Values,       ///< for Colors
    OpaqueColors, ///< PackedColor; Colors says what is shown where there are none
    Colors        ///< the same, with opacities
  };
  Coloring ColoredBy = Coloring::Values;
  Material Surface;
  /// Material of the side where values are above the isovalue; if empty, both sides are alike.
  std::optional<Material> BackSurface;
  /// Light passes through the side that values below the isovalue are on, or the other, and it is not seen.
  bool CullsFront = false;
  bool CullsBack = false;
  /// May be null: all of the field looks alike.
  std::shared_ptr<const BlockLooks> Blocks;
  /// Lit by the normals of the surface that is in each cell, not by smooth ones.
  bool Flat = false;

  /// Returns whether the surfaces let no light through anywhere, apart from the values that color
  /// them.
  bool IsOpaque() const;
  /// Returns whether the colors from values are opaque everywhere. `hasHoles`: some positions have
  /// no color.
  bool HasOpaqueColors(bool hasHoles) const;
  /// Returns whether any part of the surfaces is visible at all.
  bool IsSeen() const;
  /// Returns whether all of a surface, and both of its sides, look alike, apart from the values
  /// that color it.
  bool IsAlikeEverywhere() const;
  /// All that a picture depends on.
  void AddTo(ObjectDigest& digest) const;

  /// Returns the material of the surface as seen from a side. Null: that side is invisible.
  const Material* GetSurface(bool fromBack) const
  {
    return (fromBack ? this->CullsBack : this->CullsFront) ? nullptr
      : fromBack && this->BackSurface                      ? &*this->BackSurface
                                                           : &this->Surface;
  }
};

} // namespace rt

#endif
