// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BeamFinder_h
#define rt_BeamFinder_h

#include "DSMRayTracing/object/ObjectBeam.h"
#include "DSMRayTracing/ray/Ray.h"

#include <cstddef>
#include <memory>

namespace rt
{

/// What objects and media have in common for the rooms above: beams of rays, and the bricks that these need.
class BeamFinder
{
public:
  virtual ~BeamFinder() = default;

  /// What rays between those of `corners`, in order around them, have in common. Null: there is nothing to
  /// tell.
  virtual std::unique_ptr<ObjectBeam> FindBeam(const Ray corners[4]) const = 0;

  /// Has the first `count` bricks that a beam meets prefetched, ahead of the search; returns whether any was absent.
  /// Never waits.
  virtual bool Prefetch(const ObjectBeam&, std::size_t /*count*/) const { return false; }
};

} // namespace rt

#endif
