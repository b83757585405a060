// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/grid/IndexSpace.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace rt
{

namespace
{

/// Scales by the largest component first, so that neither tiny nor huge vectors get lost.
bool Normalize(glm::dvec3& vector)
{
  const glm::dvec3 size = glm::abs(vector);
  const double largest = std::max(std::max(size.x, size.y), size.z);
  if (!(largest > 0.0) || !std::isfinite(size.x + size.y + size.z))
  {
    return false;
  }
  vector = glm::normalize(vector / largest);
  return true;
}

} // namespace

glm::dvec3 IndexSpace::GetNormal(const double gradient[3], const glm::dvec3& rayDirection) const
{
  // A gradient is a covector: it goes to world space by the inverse transpose.
  glm::dvec3 normal = glm::dvec3(-gradient[0], -gradient[1], -gradient[2]);
  const glm::dvec3 inWorld = normal * this->WorldToIndex;
  const double square = glm::dot(inWorld, inWorld);
  // Squares neither overflow nor lose digits.
  if (square > 1e-200 && square < 1e200)
  {
    return inWorld * (1.0 / std::sqrt(square));
  }
  if (Normalize(normal))
  {
    normal = normal * this->WorldToIndex;
    if (Normalize(normal))
    {
      return normal;
    }
  }
  normal = -rayDirection;
  Normalize(normal);
  return normal;
}

} // namespace rt
