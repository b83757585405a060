// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SurfacePoint_h
#define rt_SurfacePoint_h

#include "DSMRayTracing/surface/EdgeLines.h"
#include "DSMRayTracing/surface/Material.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace rt
{

/// Where a ray meets the scene first, and what is there.
struct SurfacePoint
{
  double T = 0.0;
  glm::dvec3 Position{ 0.0 };
  glm::dvec3 Normal{ 0.0 }; ///< unit, world
  /// Normal or its opposite: that of the side from which the ray comes.
  glm::dvec3 Facing{ 0.0 };
  /// Of the surface itself, before light; straight (not premultiplied), alpha is opacity.
  glm::vec4 Color{ 1.0f };
  bool ColorIsFromArray = false;
  const Material* Surface = nullptr;
  /// World length that is more than the error of the hit, and less than the distance of two
  /// surfaces that can be told apart: where rays that leave the surface begin.
  double Clearance = 0.0;
  /// Of the triangle's sides; null: none are drawn.
  const EdgeLines* Edges = nullptr;
  glm::dvec3 Corners[3]; ///< of the triangle, world, when edges are drawn
  unsigned EdgeFlags = 0;
};

} // namespace rt

#endif
