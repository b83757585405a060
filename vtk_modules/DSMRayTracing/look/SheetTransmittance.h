// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SheetTransmittance_h
#define rt_SheetTransmittance_h

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>

namespace rt
{

/// The part of each color of light, in [0, 1], that passes a surface of that color; alpha is the opacity.
///
/// A part 1 - alpha passes straight. A translucent sheet scatters the rest in its color, and lets through
/// the same part of that. Without scattered light, the inside of nested surfaces would be nearly black.
inline glm::dvec3 GetSheetTransmittance(const glm::vec4& color)
{
  const double opacity = std::clamp(static_cast<double>(color.w), 0.0, 1.0);
  const glm::dvec3 scattered = opacity * glm::clamp(glm::dvec3(color), 0.0, 1.0);
  return (1.0 - opacity) * (1.0 + scattered);
}

/// Returns whether a ray of light with that transmittance adds less than half a step to an 8-bit
/// channel.
inline bool IsDark(const glm::dvec3& transmittance)
{
  return !(std::max({ transmittance.x, transmittance.y, transmittance.z }) > 0.5 / 255.0);
}

/// Passes a surface `crossings` times; returns whether the ray is dark then.
inline bool PassSheet(const glm::dvec3& sheet, int crossings, glm::dvec3& transmittance)
{
  for (; crossings > 0 && !IsDark(transmittance); --crossings)
  {
    transmittance *= sheet;
  }
  return IsDark(transmittance);
}

} // namespace rt

#endif
