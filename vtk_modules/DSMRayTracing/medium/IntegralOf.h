// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IntegralOf_h
#define rt_IntegralOf_h

#include "DSMRayTracing/field/Field.h"
#include "DSMRayTracing/field/lattice/VoxelIntegrals.h"
#include "DSMRayTracing/field/walk/WalkIntegrals.h"
#include "DSMRayTracing/look/ColorMap.h"
#include "DSMRayTracing/medium/MediumSheet.h"
#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/ray/ClipRegion.h"
#include "DSMRayTracing/ray/RayIntegrals.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>

namespace rt
{

template <class FieldType, class Store>
class FieldIntegralTracer;

/// The integral of a field's values along each ray over its length in world space, shown as an opaque color where the
/// ray first meets values: a kind of medium for each kind of field (Field.h).
template <class FieldType>
struct IntegralOf
{
  template <class Store>
  using Tracer = FieldIntegralTracer<FieldType, Store>;

  FieldType Field;
  /// Colors from the smallest integral to the largest one, in place of those of the smallest value and the largest one,
  /// First and Last; not null.
  std::shared_ptr<const ColorMap> Colors;
  ClipRegion Clipping;
  double Longest = 1.0; ///< length of the longest way through the field, in world space

  /// See HasLayers.
  static constexpr bool IsLayered() { return false; }

  glm::dvec3 GetColor(double integral) const
  {
    const ColorMap& map = *this->Colors;
    const double least = std::min(map.First, 0.0) * this->Longest;
    const double most = std::max(map.Last, 0.0) * this->Longest;
    const double part = most > least ? (integral - least) / (most - least) : 0.0;
    return glm::dvec3(map.Map(map.First + std::clamp(part, 0.0, 1.0) * (map.Last - map.First)));
  }

  /// All that a picture of it depends on.
  void AddTo(ObjectDigest& digest) const
  {
    this->Field.AddTo(digest);
    digest.Add(*this->Colors);
    digest.Add(this->Clipping);
    digest.Add(this->Longest);
  }
};

/// Returns whether a kind of medium has integrals (MediumTracer::Integrate).
template <class Kind>
constexpr bool HasIntegrals(const Kind&)
{
  return false;
}
template <class FieldType>
constexpr bool HasIntegrals(const IntegralOf<FieldType>&)
{
  return true;
}

/// Such a medium for rays.
template <class FieldType, class Store>
class FieldIntegralTracer final : public MediumTracer
{
public:
  /// Keeps references.
  FieldIntegralTracer(
    Store& store, typename Store::Worker& worker, const IntegralOf<FieldType>& medium)
    : Medium(medium)
    , Integrals(store, worker)
    , Cell(medium.Field.GetFinestLength())
  {
  }

  std::unique_ptr<ObjectBeam> FindBeam(const Ray corners[4]) const override
  {
    return this->Integrals.FindBeam(this->Medium.Field, corners);
  }

  bool Prefetch(const ObjectBeam& beam, std::size_t count) const override
  {
    return this->Integrals.Prefetch(this->Medium.Field, beam, count);
  }

  bool DimsLamps() const override { return false; }

  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const override
  {
    return this->Medium.Field.FindBrick(place);
  }

  RayMask March(
    const Ray* rays, RayMask wanted, ObjectBeam* beam, MediumLight& light) const override
  {
    const RayIntegrals found = this->Find(rays, wanted, beam);
    const RayMask seen = FindRays(wanted, [&](int ray) { return !std::isinf(found.First[ray]); });
    ForEachRay(seen,
      [&](int ray)
      {
        const double integral = found.Sum[ray] * glm::length(rays[ray].Direction);
        AddSheet(light, ray, found.First[ray], this->Medium.GetColor(integral), 1.0);
      });
    return FindRays(seen, [&](int ray) { return light.IsDark(ray); });
  }

  void Integrate(
    const Ray* rays, RayMask wanted, ObjectBeam* beam, double* integrals) const override
  {
    const RayIntegrals found = this->Find(rays, wanted, beam);
    ForEachRay(wanted,
      [&](int ray) { integrals[ray] += found.Sum[ray] * glm::length(rays[ray].Direction); });
  }

private:
  RayIntegrals Find(const Ray* rays, RayMask wanted, ObjectBeam* beam) const
  {
    RayIntegrals found(wanted);
    this->Medium.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      {
        this->Integrals.Add(
          this->Medium.Field, beam, parts, FindThickParts(parts, some, this->Cell), found);
        return RayMask{ 0 };
      });
    return found;
  }

  const IntegralOf<FieldType>& Medium;
  std::conditional_t<std::is_base_of_v<WalkedField<FieldType>, FieldType>,
    WalkIntegrals<FieldType, Store>, VoxelIntegrals<FieldType, Store>>
    Integrals;
  double Cell; ///< for FindThickParts
};

} // namespace rt

#endif
