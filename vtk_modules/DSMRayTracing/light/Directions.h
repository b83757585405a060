// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Directions_h
#define rt_Directions_h

#include "DSMRayTracing/light/SampleSequence.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace rt
{

/// Random directions around a unit one. Two others are at right angles to it, and to each other (Duff et al., Building
/// an Orthonormal Basis, Revisited, JCGT 2017).
class Directions
{
public:
  explicit Directions(const glm::dvec3& unit)
    : Axis(unit)
  {
    const double sign = std::copysign(1.0, unit.z);
    const double a = -1.0 / (sign + unit.z);
    const double b = unit.x * unit.y * a;
    this->Tangent = { 1.0 + sign * unit.x * unit.x * a, sign * b, -sign * unit.x };
    this->Bitangent = { b, sign + unit.y * unit.y * a, -unit.y };
  }

  /// To a disk around the direction's end, with uniform density; unit.
  glm::dvec3 GetInCone(double diskRadius, SampleSequence& random) const
  {
    const double radius = diskRadius * std::sqrt(random.Next());
    const double angle = glm::two_pi<double>() * random.Next();
    return glm::normalize(this->Axis + radius * std::cos(angle) * this->Tangent +
      radius * std::sin(angle) * this->Bitangent);
  }

  /// In the hemisphere; the density is the cosine over pi.
  glm::dvec3 GetByCosine(SampleSequence& random) const
  {
    // Uniform on the disc, then up to the sphere.
    const double square = random.Next();
    const double radius = std::sqrt(square);
    const double angle = glm::two_pi<double>() * random.Next();
    return radius * std::cos(angle) * this->Tangent + radius * std::sin(angle) * this->Bitangent +
      std::sqrt(1.0 - square) * this->Axis;
  }

  /// Anywhere, with uniform density.
  static glm::dvec3 GetAny(SampleSequence& random)
  {
    const double height = 2.0 * random.Next() - 1.0;
    const double radius = std::sqrt(1.0 - height * height);
    const double angle = glm::two_pi<double>() * random.Next();
    return { radius * std::cos(angle), radius * std::sin(angle), height };
  }

private:
  glm::dvec3 Axis;
  glm::dvec3 Tangent;
  glm::dvec3 Bitangent;
};

} // namespace rt

#endif
