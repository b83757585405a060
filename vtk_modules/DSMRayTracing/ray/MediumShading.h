// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumShading_h
#define rt_MediumShading_h

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace rt
{

/// The light of lamps far away: what a medium needs to be shaded while rays march
/// through it, without pieces that are described later.
struct MediumShading
{
  struct Lamp
  {
    glm::vec3 Direction; ///< unit, from the lamp, in world space
    glm::vec3 Diffuse;   ///< times the emission
    glm::vec3 Specular;  ///< times the opacity
    glm::vec3 Scattered; ///< times the emission, for light that is scattered evenly
  };
  std::vector<Lamp> Lamps;
  glm::vec3 Ambient{ 0.0f };        ///< times the emission
  glm::vec3 AmbientOpacity{ 0.0f }; ///< times the opacity
  float SpecularPower = 1.0f;
  bool HasHighlights = false;
  bool HasScattering = false;
  float Anisotropy = 0.0f; ///< MediumLook
  bool TwoSided = true;
  bool HasShadows = false; ///< MediumLight::Arriving is how much of the light arrives
  /// From gradients in the space of the bricks to normals against them in world space, which are not of unit length.
  glm::mat3 ToNormal{ 1.0f };
};

} // namespace rt

#endif
