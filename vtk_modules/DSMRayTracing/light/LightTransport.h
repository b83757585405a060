// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LightTransport_h
#define rt_LightTransport_h

#include "DSMRayTracing/light/Environment.h"

#include <glm/vec3.hpp>

namespace rt
{

/// Settings for the rays beyond each ray's first hit.
struct LightTransport
{
  bool Shadows = false;
  /// Shaded media are lit from both sides of the gradient; else only where light travels along it.
  bool TwoSided = true;
  /// Without them: the brightest light casts some that take away only a part of its light. One ray for each
  /// hit shows depth, and nothing becomes black.
  bool FaintShadows = false;
  /// Apparent radius of every light: the tangent of half the angle that it fills as seen from a
  /// surface; 0 gives hard shadows.
  double LightRadius = 0.0;
  /// Rays for each hit and sample of the pixel; 0 switches ambient occlusion off.
  int AmbientOcclusionSamples = 0;
  /// World units; what is farther away does not occlude.
  double AmbientOcclusionDistance = 0.0;
  /// Is occluded by what ambient occlusion's rays meet.
  Environment Surroundings;
  /// How much larger errors of media may be than MediumTolerance says: more than 1 for pictures that are soon replaced.
  double MediumErrors = 1.0;
  /// How often a ray may be mirrored.
  int MaxBounces = 1;
  /// Color of a mirrored ray that hits nothing.
  glm::vec3 Background{ 0.0f };
};

} // namespace rt

#endif
