// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PlaneSections_h
#define rt_PlaneSections_h

#include <glm/vec3.hpp>

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

} // namespace rt

#endif
