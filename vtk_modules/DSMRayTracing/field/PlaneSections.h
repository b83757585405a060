// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PlaneSections_h
#define rt_PlaneSections_h

#include "DSMCore/base/Block.h"
#include "DSMRayTracing/object/ObjectBeam.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rt
{

/// World space; both sides are alike.
struct SectionPlane
{
  glm::dvec3 Normal{ 0.0 }; ///< any length but 0
  glm::dvec3 Point{ 0.0 };
};

/// Intersection of a ray with a plane within a field. `Place` is the position in the field's own
/// coordinates.
template <class PlaceType>
struct SectionHit
{
  double T = 0.0;
  int Plane = -1; ///< index; -1: none yet
  PlaceType At;
};

/// The bricks that planes pass through within a beam.
struct SectionBeam final : ObjectBeam
{
  bool IsKnown = false;             ///< false: rays may meet other bricks, too
  std::vector<dsm::BlockId> Bricks; ///< plane by plane, from the nearest one

  bool MayMeet() const override { return !this->IsKnown || !this->Bricks.empty(); }
  /// Called when a ray has come to a brick.
  void Reach(dsm::BlockId brick)
  {
    const auto begin = this->Bricks.begin() + static_cast<std::ptrdiff_t>(this->Reached);
    const auto found = std::find(begin, this->Bricks.end(), brick);
    this->Reached += found == this->Bricks.end() ? 0 : static_cast<std::size_t>(found - begin) + 1;
  }
};

} // namespace rt

#endif
