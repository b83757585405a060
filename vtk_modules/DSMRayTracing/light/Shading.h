// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Shading_h
#define rt_Shading_h

#include "DSMRayTracing/light/Light.h"
#include "DSMRayTracing/light/SampleSequence.h"
#include "DSMRayTracing/look/Material.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace rt
{

/// Light that arrives at a point if nothing is in between.
struct Incidence
{
  glm::dvec3 Direction{ 0.0 }; ///< unit, from the light to the point
  double Distance = 0.0;       ///< to the light; infinite for a directional one
  double Attenuation = 0.0;
};

/// World space.
Incidence GetIncidence(const Light& light, const glm::dvec3& point);

/// Returns a unit direction from the point to the light or, where lights have a radius
/// (LightTransport::LightRadius), to a random place on it.
glm::dvec3 AimAt(const Incidence& incidence, double lightRadius, SampleSequence& random);

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
inline bool Arrives(const Incidence& incidence, const ShadingPoint& point)
{
  return -glm::dot(point.Normal, incidence.Direction) > 0.0 && incidence.Attenuation > 0.0;
}

/// The color, in [0, 1], that a surface sends to the viewer; the formula of VTK's OpenGL polydata
/// mapper (Phong, for any number of lights):
///
///   ambient + sum over lights of attenuation * light * (diffuse * N.L + specular * (R.V)^power)
///
/// with (N.L)^power for a lone headlight, as there, and diffuse times the light from all around. Without
/// lighting, or without any light, the surface shows ambient + diffuse. `visibility(light, incidence)`
/// is called for lights that face the surface: the part of each color that arrives (glm::dvec3).
template <class Visibility>
glm::vec3 Shade(const std::vector<Light>& lights, const Material& surface,
  const ShadingPoint& point, Visibility&& visibility)
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
  for (const Light& light : lights)
  {
    const Incidence incidence = GetIncidence(light, point.Position);
    if (!Arrives(incidence, point))
    {
      continue;
    }
    const double cosine = -glm::dot(point.Normal, incidence.Direction);
    const glm::dvec3 arriving =
      incidence.Attenuation * glm::dvec3(light.Color) * visibility(light, incidence);
    color += arriving * diffuseColor * cosine;
    if (surface.Specular > 0.0f)
    {
      const glm::dvec3 mirrored = glm::reflect(incidence.Direction, point.Normal);
      const double highlight =
        light.IsLoneHeadlight ? cosine : std::max(0.0, glm::dot(mirrored, point.ToViewer));
      color += arriving * specularColor * std::pow(highlight, surface.SpecularPower);
    }
  }
  return glm::clamp(glm::vec3(color), 0.0f, 1.0f);
}

} // namespace rt

#endif
