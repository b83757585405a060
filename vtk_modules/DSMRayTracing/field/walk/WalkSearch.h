// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WalkSearch_h
#define rt_WalkSearch_h

#include "DSMRayTracing/field/walk/FieldSegment.h"
#include "DSMRayTracing/object/ObjectBeam.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <cstddef>
#include <memory>

namespace rt
{

/// Base of what finds something by a field's Walk, without foresight.
template <class FieldType, class Store>
class WalkSearch
{
public:
  WalkSearch(Store& store, typename Store::Worker& worker)
    : Way(store, worker)
  {
  }

  ///@{
  /// See BeamFinder.
  template <class... Searched>
  std::unique_ptr<ObjectBeam> FindBeam(const Searched&...) const
  {
    return nullptr;
  }
  template <class Searched>
  bool Prefetch(const Searched&, const ObjectBeam&, std::size_t) const
  {
    return false;
  }
  ///@}

protected:
  using Segment = FieldSegment<typename FieldType::Place>;

  /// Walk::Find for the `wanted` of some rays: calls `visit(ray, segment)`. `getPredicate(some)`: mayHold for some of
  /// the rays. Returns the rays for which a visit returned true.
  template <class GetPredicate, class Visit>
  RayMask FindEach(const FieldType& field, const Ray* rays, RayMask wanted,
    const GetPredicate& getPredicate, const Visit& visit) const
  {
    if constexpr (FieldType::WalksTogether)
    {
      return this->Way.FindEach(field, rays, wanted, getPredicate, visit);
    }
    else
    {
      return FindRays(wanted,
        [&](int ray)
        {
          return this->Way.Find(field, rays[ray], getPredicate(GetBit(ray)),
            [&](const Segment& segment) { return visit(ray, segment); });
        });
    }
  }

  typename FieldType::template Walk<Store> Way;
};

} // namespace rt

#endif
