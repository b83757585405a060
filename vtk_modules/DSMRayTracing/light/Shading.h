// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Shading_h
#define rt_Shading_h

#include "DSMRayTracing/light/Light.h"
#include "DSMRayTracing/look/Material.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace rt
{

/// A point of a surface, and from where it is looked at. World space; vectors are unit.
struct ShadingPoint
{
  glm::dvec3 Position{ 0.0 };
  /// Normal of the visible side. At silhouettes an interpolated one may point away from the viewer.
  glm::dvec3 Normal{ 0.0 };
  glm::dvec3 ToViewer{ 0.0 };
  /// Takes the place of the diffuse color, and, as in VTK, when it comes from an array also of the
  /// ambient one.
  glm::vec3 Color{ 1.0f };
  bool ColorIsFromArray = false;
  bool IsLit = true; ///< Material::Lighting
  /// Part of the surroundings that the point sees; dims what comes from all sides, and the diffuse
  /// light as ParaView's own ambient occlusion does.
  double AmbientVisibility = 1.0;
  /// Light from all around, as far as it arrives; reflected as diffuse light.
  glm::dvec3 Surroundings{ 0.0 };
  bool HasSurroundings = false;
  /// A line on the surface, and how much of the point it covers, in [0, 1]. There the surface shows the
  /// line's color in place of ambient and diffuse light, as in VTK.
  glm::vec3 LineColor{ 0.0f };
  double LineCover = 0.0;
};

/// Returns whether light from there makes the surface brighter, unless something is in between.
inline bool Arrives(const LightSample& light, const ShadingPoint& point)
{
  return -glm::dot(point.Normal, light.Direction) > 0.0 &&
    glm::any(glm::greaterThan(light.Radiance, glm::dvec3(0.0)));
}

/// The color, in [0, 1], that a surface sends to the viewer; the formula of VTK's OpenGL polydata
/// mapper (Phong, for any number of lights):
///
///   ambient + sum over lights of radiance * (diffuse * N.L + specular * (R.V)^power)
///
/// with (N.L)^power for a lone headlight, as there, and diffuse times the light from all around. Without
/// lighting, or without any light, the surface shows ambient + diffuse. `arriving(number)` returns the
/// light of a lamp that arrives, as a LightSample.
template <class Arriving>
glm::vec3 Shade(const std::vector<Light>& lights, const Material& surface,
  const ShadingPoint& point, Arriving&& arriving)
{
  const glm::vec3 ambientColor = point.ColorIsFromArray ? point.Color : surface.AmbientColor;
  const double uncovered = 1.0 - point.LineCover;
  glm::dvec3 color =
    uncovered * point.AmbientVisibility * glm::dvec3(surface.Ambient * ambientColor) +
    point.LineCover * glm::dvec3(point.LineColor);
  const glm::dvec3 diffuseColor =
    uncovered * point.AmbientVisibility * glm::dvec3(surface.Diffuse * point.Color);
  if (!surface.Lighting || (lights.empty() && !point.HasSurroundings))
  {
    return glm::clamp(glm::vec3(color + diffuseColor), 0.0f, 1.0f);
  }
  color += uncovered * glm::dvec3(surface.Diffuse * point.Color) * point.Surroundings;
  const glm::dvec3 specularColor = surface.Specular * surface.SpecularColor;
  for (std::size_t number = 0; number < lights.size(); ++number)
  {
    const LightSample light = arriving(number);
    if (!Arrives(light, point))
    {
      continue;
    }
    const double cosine = -glm::dot(point.Normal, light.Direction);
    color += light.Radiance * diffuseColor * cosine;
    if (surface.Specular > 0.0f)
    {
      const glm::dvec3 mirrored = glm::reflect(light.Direction, point.Normal);
      const double highlight =
        lights[number].IsLoneHeadlight ? cosine : std::max(0.0, glm::dot(mirrored, point.ToViewer));
      color += light.Radiance * specularColor * std::pow(highlight, surface.SpecularPower);
    }
  }
  return glm::clamp(glm::vec3(color), 0.0f, 1.0f);
}

} // namespace rt

#endif
