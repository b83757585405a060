// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WalkSearch_h
#define rt_WalkSearch_h

#include "DSMRayTracing/field/walk/FieldSegment.h"
#include "DSMRayTracing/object/ObjectBeam.h"

#include <cstddef>
#include <memory>

namespace rt
{

/// Base of what finds something by a field's Walk: ray by ray, and without foresight.
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

  typename FieldType::template Walk<Store> Way;
};

} // namespace rt

#endif
