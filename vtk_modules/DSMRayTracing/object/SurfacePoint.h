// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SurfacePoint_h
#define rt_SurfacePoint_h

#include "DSMRayTracing/look/Material.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace rt
{

/// First intersection of a ray with the scene, and the surface's properties there.
struct SurfacePoint
{
  double T = 0.0;
  glm::dvec3 Position{ 0.0 };
  glm::dvec3 Normal{ 0.0 }; ///< unit, world
  /// Normal or its opposite: that of the side from which the ray comes.
  glm::dvec3 Facing{ 0.0 };
  /// Color of the surface itself, before light; straight (not premultiplied), alpha is opacity.
  glm::vec4 Color{ 1.0f };
  bool ColorIsFromArray = false;
  const Material* Surface = nullptr;
  /// World length that is more than the error of the hit, and less than the distance of two
  /// surfaces that can be told apart: where rays that leave the surface begin.
  double Clearance = 0.0;
  /// A line that is drawn on the surface, and how much of the place it covers, in [0, 1].
  glm::vec3 LineColor{ 0.0f };
  double LineCover = 0.0;
};

} // namespace rt

#endif
