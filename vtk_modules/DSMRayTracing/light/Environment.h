// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Environment_h
#define rt_Environment_h

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace rt
{

/// Light that comes from everywhere, a gradient from below to above. World space.
struct Environment
{
  glm::dvec3 Up{ 0.0, 1.0, 0.0 }; ///< unit
  /// Colors of the directions straight down and straight up; in between they are interpolated by
  /// the cosine. Black: no environment.
  glm::vec3 Lower{ 0.0f };
  glm::vec3 Upper{ 0.0f };

  bool IsBlack() const { return this->Lower == glm::vec3(0.0f) && this->Upper == glm::vec3(0.0f); }
  /// From a unit direction.
  glm::dvec3 GetLight(const glm::dvec3& from) const
  {
    return glm::mix(
      glm::dvec3(this->Lower), glm::dvec3(this->Upper), 0.5 + 0.5 * glm::dot(from, this->Up));
  }
  /// Returns the unoccluded irradiance of a surface with this unit normal, divided by pi: the mean light over the
  /// hemisphere, weighted by the cosine.
  glm::dvec3 GetLightOnto(const glm::dvec3& normal) const
  {
    // The weighted mean of the directions is two thirds of the normal.
    return this->GetLight(2.0 / 3.0 * normal);
  }
};

} // namespace rt

#endif
