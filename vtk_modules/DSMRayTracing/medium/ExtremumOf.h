// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ExtremumOf_h
#define rt_ExtremumOf_h

#include "DSMRayTracing/look/ColorMap.h"
#include "DSMRayTracing/medium/MediumSheet.h"
#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/ray/ClipRegion.h"
#include "DSMRayTracing/ray/RayExtrema.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <memory>

namespace rt
{

template <class FieldType, class Store>
class FieldExtremumTracer;

/// The largest value of a field that a ray meets, or the smallest one, shown as a sheet where the ray meets it first: a
/// kind of medium for each kind of field (Field.h).
template <class FieldType>
struct ExtremumOf
{
  template <class Store>
  using Tracer = FieldExtremumTracer<FieldType, Store>;

  FieldType Field;
  /// Colors and opacities of values; not null. Values beyond its range are as those at its ends.
  std::shared_ptr<const ColorMap> Colors;
  bool IsMinimum = false;
  ClipRegion Clipping;

  /// See HasLayers.
  static constexpr bool IsLayered() { return false; }

  /// All that a picture of it depends on.
  void AddTo(ObjectDigest& digest) const
  {
    this->Field.AddTo(digest);
    digest.Add(*this->Colors);
    digest.Add(this->IsMinimum);
    digest.Add(this->Clipping);
  }
};

/// Such a medium for rays.
template <class FieldType, class Store>
class FieldExtremumTracer final : public MediumTracer
{
public:
  /// Keeps references.
  FieldExtremumTracer(
    Store& store, typename Store::Worker& worker, const ExtremumOf<FieldType>& medium)
    : Medium(medium)
    , Extrema(store, worker)
    , Sign(medium.IsMinimum ? -1.0 : 1.0)
    , Limit(this->Sign * medium.Colors->FindUnseenEnd(medium.IsMinimum))
    , Goal(this->Sign * (medium.IsMinimum ? medium.Colors->First : medium.Colors->Last))
    , Cell(medium.Field.GetFinestLength())
  {
  }

  std::unique_ptr<ObjectBeam> FindBeam(const Ray corners[4]) const override
  {
    return this->Extrema.FindBeam(this->Medium.Field, this->Sign, this->Limit, corners);
  }

  bool Prefetch(const ObjectBeam& beam, std::size_t count) const override
  {
    return this->Extrema.Prefetch(this->Medium.Field, beam, count);
  }

  bool DimsLamps() const override { return false; }

  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const override
  {
    return this->Medium.Field.FindBrick(place);
  }

  RayMask March(
    const Ray* rays, RayMask wanted, ObjectBeam* beam, MediumLight& light) const override
  {
    RayExtrema extrema(wanted, this->Medium.IsMinimum, this->Limit, this->Goal);
    this->Medium.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      {
        const RayMask thick = FindThickParts(parts, some, this->Cell);
        return this->Extrema.Find(this->Medium.Field, this->Limit, beam, parts, thick, extrema);
      });
    ForEachRay(extrema.Found,
      [&](int ray)
      {
        const glm::vec4 look = this->Medium.Colors->Map(this->Sign * extrema.Value[ray]);
        AddSheet(light, ray, extrema.T[ray], glm::vec3(look), look.w);
      });
    return FindRays(extrema.Found, [&](int ray) { return light.IsDark(ray); });
  }

private:
  const ExtremumOf<FieldType>& Medium;
  typename FieldType::template Extrema<Store> Extrema;
  double Sign;
  double Limit;
  double Goal;
  double Cell; ///< for FindThickParts
};

} // namespace rt

#endif
