// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumSheet_h
#define rt_MediumSheet_h

#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rt
{

/// Gives to `light` what a sheet across a ray adds, as thin as can be: its color (not premultiplied) and opacity.
inline void AddSheet(MediumLight& light, int ray, double t, const glm::dvec3& color, double opacity)
{
  // Anything behind such an opacity is invisible anyway.
  constexpr double most = 1.0 - 1e-15;
  const double depth = -std::log1p(-std::clamp(opacity, 0.0, most));
  const glm::dvec3 emission = depth * color;
  light.Add(ray,
    { t, std::nextafter(t, std::numeric_limits<double>::infinity()),
      Lanes(emission.x, emission.y, emission.z, depth) });
}

/// Returns those of the `wanted` parts of rays that a single value may stand for. Rounding leaves slivers of a medium
/// in front of the face of a cut, which is a surface. A sheet there would hide the face. `cell`: length of a cell's
/// shortest edge, in world space.
inline RayMask FindThickParts(const Ray* parts, RayMask wanted, double cell)
{
  constexpr double least = 1e-4; // of a cell, as the clearance of a slice
  return FindRays(wanted,
    [&](int ray)
    {
      const Ray& part = parts[ray];
      return (part.Max - part.Min) * glm::length(part.Direction) > least * cell;
    });
}

} // namespace rt

#endif
