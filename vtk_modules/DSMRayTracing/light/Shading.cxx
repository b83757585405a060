// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/light/Shading.h"

#include "DSMRayTracing/light/Directions.h"

#include <cmath>
#include <limits>

namespace rt
{

Incidence GetIncidence(const Light& light, const glm::dvec3& point)
{
  if (light.Type == Light::Kind::Directional)
  {
    return { light.Direction, std::numeric_limits<double>::infinity(), 1.0 };
  }
  const glm::dvec3 way = point - light.Position;
  const double distance = glm::length(way);
  // At the light itself there is no direction; its own will do.
  const glm::dvec3 direction = distance > 0.0 ? way / distance : light.Direction;
  double attenuation = 1.0 /
    (light.Attenuation.x + light.Attenuation.y * distance +
      light.Attenuation.z * distance * distance);
  if (light.Type == Light::Kind::Cone)
  {
    const double cosine = glm::dot(direction, light.Direction);
    attenuation = cosine >= light.ConeCosine ? attenuation * std::pow(cosine, light.Exponent) : 0.0;
  }
  return { direction, distance, attenuation };
}

glm::dvec3 AimAt(const Incidence& incidence, double lightRadius, SampleSequence& random)
{
  const glm::dvec3 center = -incidence.Direction;
  return lightRadius > 0.0 ? Directions(center).GetInCone(lightRadius, random) : center;
}

} // namespace rt
