// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/kernel/Shading.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace rt
{

namespace
{

/// What of a light arrives at a point.
struct Incidence
{
  glm::dvec3 Direction; ///< unit, from the light to the point
  double Attenuation;
};

Incidence GetIncidence(const Light& light, const glm::dvec3& point)
{
  if (light.Type == Light::Kind::Directional)
  {
    return { light.Direction, 1.0 };
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
  return { direction, attenuation };
}

} // namespace

glm::vec3 Shade(const std::vector<Light>& lights, const Material& surface, const glm::dvec3& point,
  const glm::dvec3& normal, const glm::dvec3& toViewer, const glm::vec3& surfaceColor,
  bool fromArray)
{
  const glm::vec3 ambientColor = fromArray ? surfaceColor : surface.AmbientColor;
  glm::dvec3 color = surface.Ambient * ambientColor;
  const glm::dvec3 diffuseColor = surface.Diffuse * surfaceColor;
  if (!surface.Lighting || lights.empty())
  {
    return glm::clamp(glm::vec3(color + diffuseColor), 0.0f, 1.0f);
  }
  const glm::dvec3 specularColor = surface.Specular * surface.SpecularColor;
  const glm::dvec3 facing = glm::dot(normal, toViewer) < 0.0 ? -normal : normal;
  for (const Light& light : lights)
  {
    const Incidence incidence = GetIncidence(light, point);
    const double cosine = -glm::dot(facing, incidence.Direction);
    if (!(cosine > 0.0 && incidence.Attenuation > 0.0))
    {
      continue;
    }
    const glm::dvec3 arriving = incidence.Attenuation * glm::dvec3(light.Color);
    color += arriving * diffuseColor * cosine;
    if (surface.Specular > 0.0f)
    {
      const glm::dvec3 mirrored = glm::reflect(incidence.Direction, facing);
      const double highlight = std::max(0.0, glm::dot(mirrored, toViewer));
      color += arriving * specularColor * std::pow(highlight, surface.SpecularPower);
    }
  }
  return glm::clamp(glm::vec3(color), 0.0f, 1.0f);
}

} // namespace rt
