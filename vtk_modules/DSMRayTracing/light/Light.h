// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Light_h
#define rt_Light_h

#include <glm/vec3.hpp>

namespace rt
{

/// World space. Colors include the intensity.
struct Light
{
  enum class Kind
  {
    Directional,
    Positional,
    Cone
  };
  Kind Type = Kind::Directional;
  /// The scene's only light, and it shines along the view: as VTK, the highlight is then a power of
  /// the light's angle, not of the mirrored light's.
  bool IsLoneHeadlight = false;
  glm::dvec3 Position{ 0.0 };
  /// Unit, from the light into the scene.
  glm::dvec3 Direction{ 0.0, 0.0, -1.0 };
  glm::vec3 Color{ 1.0f };
  /// The light that it adds in shaded media, from all sides. Ignored if it is a lone headlight, as in VTK.
  glm::vec3 AmbientColor{ 0.0f };
  /// Cosine of the cone's half angle, exponent of the fall-off within it, and constant, linear and
  /// quadratic attenuation, as in vtkLight.
  float ConeCosine = 0.0f;
  float Exponent = 1.0f;
  glm::vec3 Attenuation{ 1.0f, 0.0f, 0.0f };
};

} // namespace rt

#endif
