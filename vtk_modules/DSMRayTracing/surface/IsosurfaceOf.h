// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfaceOf_h
#define rt_IsosurfaceOf_h

#include "DSMRayTracing/field/LevelSets.h"
#include "DSMRayTracing/look/SheetTransmittance.h"
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/ray/ClipRegion.h"
#include "DSMRayTracing/surface/IsosurfaceLook.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <memory>
#include <vector>

namespace rt
{

template <class FieldType, class Store>
class IsosurfaceTracer;

/// Isosurfaces of one field: a kind of object for each kind of field (Field.h).
template <class FieldType>
struct IsosurfaceOf : LevelSets<FieldType>
{
  template <class Store>
  using Tracer = IsosurfaceTracer<FieldType, Store>;
  using Values = typename FieldType::Values;

  /// Color the surfaces, as Look says; may be null: then the material's diffuse color is used.
  std::shared_ptr<const Values> ColorValues;
  IsosurfaceLook Look;
  ClipRegion Clipping;

  /// Returns whether the surfaces let no light through anywhere.
  bool IsOpaque() const
  {
    return this->Look.IsOpaque() &&
      (!this->ColorValues || this->Look.HasOpaqueColors(FieldType::HasHoles(*this->ColorValues)));
  }

  /// GetSheetTransmittance for each isovalue. Empty where it is not the same all over a surface and on both of
  /// its sides.
  std::vector<glm::dvec3> GetSheetTransmittances() const
  {
    const IsosurfaceLook& look = this->Look;
    const bool isColoredByItself = this->ColorValues.get() == &this->Field.GetValues() &&
      look.ColoredBy == IsosurfaceLook::Coloring::Values && !look.Colors.Categories;
    std::vector<glm::dvec3> sheets;
    if (!look.IsAlikeEverywhere() || (this->ColorValues && !isColoredByItself))
    {
      return sheets;
    }
    for (std::size_t index = 0; index < this->Isovalues.size(); ++index)
    {
      glm::vec4 color = this->ColorValues ? look.Colors.Map(this->Isovalues[index])
                                          : glm::vec4(look.Surface.DiffuseColor, 1.0f);
      color.w *= look.Surface.Opacity;
      color.w *= look.Opacities.empty() ? 1.0f : look.Opacities[index];
      sheets.push_back(GetSheetTransmittance(color));
    }
    return sheets;
  }

  /// All that the first hits of rays depend on.
  void AddShapeTo(ObjectDigest& digest) const
  {
    this->Field.AddTo(digest);
    digest.AddAll(this->Isovalues, this->Look.IsSeen(), this->Clipping);
  }

  /// All that a picture of them depends on.
  void AddTo(ObjectDigest& digest) const
  {
    this->AddShapeTo(digest);
    digest.Add(this->ColorValues != nullptr);
    if (this->ColorValues)
    {
      FieldType::AddTo(digest, *this->ColorValues);
    }
    this->Look.AddTo(digest);
  }
};

} // namespace rt

#endif
