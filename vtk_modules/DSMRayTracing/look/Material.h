// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Material_h
#define rt_Material_h

#include <glm/vec3.hpp>

namespace rt
{

/// As vtkProperty: colors in [0, 1], coefficients as there.
struct Material
{
  float Ambient = 0.0f;
  float Diffuse = 1.0f;
  float Specular = 0.0f;
  float SpecularPower = 1.0f;
  glm::vec3 AmbientColor{ 1.0f };
  glm::vec3 DiffuseColor{ 1.0f };
  glm::vec3 SpecularColor{ 1.0f };
  float Opacity = 1.0f;
  /// Part of the light that is mirrored; the rest is the surface's own color.
  float Reflectivity = 0.0f;
  /// Off: the surface shows its color as it is.
  bool Lighting = true;
};

} // namespace rt

#endif
