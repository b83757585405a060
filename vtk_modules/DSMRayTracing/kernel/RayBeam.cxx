// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/kernel/RayBeam.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace rt
{

namespace
{

/// Farther than rounding may put a ray out of the beam: in cells, and relative to where it begins.
constexpr double Margin = 1e-3;
constexpr double RelativeMargin = 1e-9;

glm::dvec3 ToVector(const Lanes& lanes)
{
  return { lanes[0], lanes[1], lanes[2] };
}

} // namespace

bool RayBeam::Set(const GridRay corners[4])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Forward[axis] = corners[0].Step[axis] > 0.0;
    for (int corner = 0; corner < 4; ++corner)
    {
      if (corners[corner].Step[axis] == 0.0 || corners[corner].Step[axis] != corners[0].Step[axis])
      {
        return false;
      }
    }
  }
  for (int corner = 0; corner < 4; ++corner)
  {
    const GridRay& other = corners[(corner + 1) % 4];
    const GridRay& opposite = corners[(corner + 2) % 4];
    const glm::dvec3 begin = ToVector(corners[corner].Origin);
    // The ends, which are apart also where all rays begin in one point.
    const glm::dvec3 otherEnd = ToVector(other.Origin + other.Direction);
    const glm::dvec3 oppositeEnd = ToVector(opposite.Origin + opposite.Direction);
    glm::dvec3 normal = glm::cross(ToVector(corners[corner].Direction), otherEnd - begin);
    normal /= glm::length(normal);
    const double inside = glm::dot(normal, oppositeEnd - begin);
    normal = inside < 0.0 ? -normal : normal;
    const double least = glm::dot(normal, begin) - Margin -
      RelativeMargin * (std::abs(begin.x) + std::abs(begin.y) + std::abs(begin.z));
    if (!std::isfinite(least) || inside == 0.0)
    {
      return false;
    }
    Side& side = this->Sides[corner];
    // Not so flat that its reciprocal is infinite: by much less than the margin.
    constexpr double flat = 1e-30;
    const double x = std::abs(normal.x) < flat ? flat : normal.x;
    side.Normal[0] = x;
    side.Normal[1] = normal.y;
    side.Normal[2] = normal.z;
    side.InverseX = 1.0 / x;
    side.Least = least;
  }
  return true;
}

RayBeam::Cubes RayBeam::GetCubes(double edge) const
{
  Cubes cubes{ edge, {} };
  for (int number = 0; number < 4; ++number)
  {
    const Side& side = this->Sides[number];
    // From a cube's lower corner to the one that is farthest inside.
    const double reach = edge *
      (std::max(side.Normal[0], 0.0) + std::max(side.Normal[1], 0.0) +
        std::max(side.Normal[2], 0.0));
    cubes.Least[number] = side.Least - reach;
  }
  return cubes;
}

} // namespace rt
