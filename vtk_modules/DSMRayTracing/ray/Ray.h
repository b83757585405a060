// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Ray_h
#define rt_Ray_h

#include <glm/vec3.hpp>

namespace rt
{

/// World space; points Origin + t Direction with t in [Min, Max]. Direction need not be unit.
struct Ray
{
  glm::dvec3 Origin{ 0.0 };
  glm::dvec3 Direction{ 0.0, 0.0, 1.0 };
  double Min = 0.0;
  double Max = 0.0;
};

} // namespace rt

#endif
