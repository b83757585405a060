// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumOf_h
#define rt_MediumOf_h

#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/ray/ClipRegion.h"

#include <cstddef>
#include <memory>

namespace rt
{

template <class FieldType, class Store>
class FieldMediumTracer;

/// A medium whose emission and extinction are a function of a field's values: a kind of medium for each kind of field,
/// which offers, besides what IsosurfaceOf needs, Media: what takes rays through it (LatticeMedia says how).
template <class FieldType>
struct MediumOf
{
  template <class Store>
  using Tracer = FieldMediumTracer<FieldType, Store>;

  FieldType Field;
  std::shared_ptr<const TransferFunction> Function; ///< not null
  ClipRegion Clipping;

  /// All that a picture of it depends on.
  void AddTo(ObjectDigest& digest) const
  {
    this->Field.AddTo(digest);
    digest.Add(this->Function->GetDigest());
    digest.Add(this->Clipping);
  }
};

/// Such a medium for rays.
template <class FieldType, class Store>
class FieldMediumTracer final : public MediumTracer
{
public:
  /// Keeps references.
  FieldMediumTracer(Store& store, typename Store::Worker& worker, const MediumOf<FieldType>& medium)
    : Medium(medium)
    , Media(store, worker)
  {
  }

  std::unique_ptr<ObjectBeam> FindBeam(const Ray corners[4]) const override
  {
    return this->Media.FindBeam(this->Medium.Field, *this->Medium.Function, corners);
  }

  bool Prefetch(const ObjectBeam& beam, std::size_t count) const override
  {
    return this->Media.Prefetch(this->Medium.Field, beam, count);
  }

  RayMask March(
    const Ray* rays, RayMask wanted, ObjectBeam* beam, MediumLight& light) const override
  {
    if (!this->Medium.Function->IsSeenAtAll())
    {
      return 0;
    }
    return this->Medium.Clipping.SearchParts(rays, wanted,
      [&](const Ray* parts, RayMask some)
      {
        return this->Media.March(
          this->Medium.Field, *this->Medium.Function, beam, parts, some, light);
      });
  }

private:
  const MediumOf<FieldType>& Medium;
  typename FieldType::template Media<Store> Media;
};

} // namespace rt

#endif
