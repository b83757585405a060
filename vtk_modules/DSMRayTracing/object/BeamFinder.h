// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BeamFinder_h
#define rt_BeamFinder_h

#include "DSMRayTracing/object/ObjectBeam.h"
#include "DSMRayTracing/ray/Ray.h"

#include <cstddef>
#include <memory>

namespace rt
{

/// Common interface of objects and media: beams of rays, and the bricks that these need.
class BeamFinder
{
public:
  virtual ~BeamFinder() = default;

  /// Finds the data that all rays between the four `corners`, in order around the beam, have in
  /// common. Null: none.
  virtual std::unique_ptr<ObjectBeam> FindBeam(const Ray corners[4]) const = 0;

  /// Has the first `count` bricks that a beam meets prefetched, ahead of the search; returns whether any was absent.
  /// Never waits.
  virtual bool Prefetch(const ObjectBeam&, std::size_t /*count*/) const { return false; }
};

} // namespace rt

#endif
