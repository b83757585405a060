// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SliceOf_h
#define rt_SliceOf_h

#include "DSMRayTracing/field/PlaneSections.h"
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/ray/ClipRegion.h"
#include "DSMRayTracing/surface/IsosurfaceLook.h"

#include <limits>
#include <memory>
#include <vector>

namespace rt
{

template <class FieldType, class Store>
class SliceTracer;

/// Planes through a field, which show its values or those of another array: a kind of object for each kind of field
/// (Field.h). A plane is there where the field has cells.
template <class FieldType>
struct SliceOf
{
  template <class Store>
  using Tracer = SliceTracer<FieldType, Store>;
  using Values = typename FieldType::Values;

  FieldType Field;
  std::vector<SectionPlane> Planes;
  /// Color the planes, as Look says; may be null: then the material's diffuse color is used. May be the field's own.
  std::shared_ptr<const Values> ColorValues;
  /// Both sides are alike, whatever it says of back faces. Opacities has no meaning.
  IsosurfaceLook Look;
  /// Places have the color of the nearest sample, not that of interpolated values.
  bool NearestValues = false;
  /// The planes are there only where the field has a value from Least to Most.
  double Least = -std::numeric_limits<double>::infinity();
  double Most = std::numeric_limits<double>::infinity();
  ClipRegion Clipping;

  /// Returns whether the planes are limited by values.
  bool DependsOnValues() const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return this->Least > -infinity || this->Most < infinity;
  }

  /// Returns whether the planes are opaque wherever they exist.
  bool IsOpaque() const
  {
    return this->Look.Surface.Opacity >= 1.0f &&
      (!this->Look.Blocks || this->Look.Blocks->AreOpaque()) &&
      (!this->ColorValues || this->Look.HasOpaqueColors(FieldType::HasHoles(*this->ColorValues)));
  }

  /// All that the first hits of rays depend on.
  void AddShapeTo(ObjectDigest& digest) const
  {
    this->Field.AddTo(digest);
    digest.Add(this->Planes.size());
    for (const SectionPlane& plane : this->Planes)
    {
      digest.Add(plane.Normal);
      digest.Add(plane.Point);
    }
    digest.AddAll(this->Least, this->Most, this->Clipping);
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
    digest.Add(this->NearestValues);
  }
};

} // namespace rt

#endif
