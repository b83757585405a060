// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/lattice/RayBeam.h"

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
    this->Lower[axis] = -HUGE_VAL;
    this->Upper[axis] = HUGE_VAL;
    this->Forward[axis] = corners[0].Step[axis] > 0.0;
    this->Way[axis] = corners[0].Direction[axis] + corners[2].Direction[axis];
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
    this->SetSide(corner, &normal.x, least);
  }
  return true;
}

bool RayBeam::Set(const IndexSpace& space, const Ray corners[4])
{
  GridRay lines[4];
  for (int corner = 0; corner < 4; ++corner)
  {
    if (!space.GetGridRay(corners[corner], lines[corner]))
    {
      return false;
    }
  }
  return this->Set(lines);
}

void RayBeam::SetSide(int number, const double normal[3], double least)
{
  Side& side = this->Sides[number];
  // Not so flat that its reciprocal is infinite: by much less than the margin.
  constexpr double flat = 1e-30;
  const double x = std::abs(normal[0]) < flat ? flat : normal[0];
  side.Normal[0] = x;
  side.Normal[1] = normal[1];
  side.Normal[2] = normal[2];
  side.InverseX = 1.0 / x;
  side.Least = least;
}

void RayBeam::Set(const RayPacket& packet)
{
  glm::dvec3 sum(0.0);
  std::fill_n(this->Lower, 3, HUGE_VAL);
  std::fill_n(this->Upper, 3, -HUGE_VAL);
  const auto visit = [&](const auto& take)
  {
    for (RayPacket::Mask left = packet.Rays; left != 0; left &= left - 1)
    {
      take(GetLowest(left));
    }
  };
  std::copy_n(packet.Forward, 3, this->Forward);
  visit(
    [&](int lane)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        const double direction = packet.Direction[axis][lane];
        const double enter = packet.Origin[axis][lane] + packet.Enter[lane] * direction;
        const double leave = packet.Origin[axis][lane] + packet.Leave[lane] * direction;
        this->Lower[axis] = std::min(this->Lower[axis], std::min(enter, leave) - Margin);
        this->Upper[axis] = std::max(this->Upper[axis], std::max(enter, leave) + Margin);
        sum[axis] += std::abs(direction);
      }
    });
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Way[axis] = this->Forward[axis] ? sum[axis] : -sum[axis];
  }
  // The axis along which the rays move most: on both planes across it at the ends of the beam the
  // rays fill a rectangle, and between them they stay between the rectangles.
  const int most = sum.x >= sum.y && sum.x >= sum.z ? 0 : (sum.y >= sum.z ? 1 : 2);
  const double begin = this->Lower[most];
  const double end = this->Upper[most];
  for (int other = 0; other < 2; ++other)
  {
    const int axis = (most + 1 + other) % 3;
    double low[2] = { HUGE_VAL, HUGE_VAL };
    double high[2] = { -HUGE_VAL, -HUGE_VAL };
    visit(
      [&](int lane)
      {
        const double slope = packet.Direction[axis][lane] * packet.Inverse[most][lane];
        const double origin = packet.Origin[axis][lane];
        const double places[2] = { origin + (begin - packet.Origin[most][lane]) * slope,
          origin + (end - packet.Origin[most][lane]) * slope };
        for (int side = 0; side < 2; ++side)
        {
          low[side] = std::min(low[side], places[side]);
          high[side] = std::max(high[side], places[side]);
        }
      });
    for (const bool upper : { false, true })
    {
      const double* const places = upper ? high : low;
      const double slope = (places[1] - places[0]) / (end - begin);
      const double sign = upper ? -1.0 : 1.0;
      double normal[3] = { 0.0, 0.0, 0.0 };
      normal[axis] = sign;
      normal[most] = -sign * slope;
      const double room =
        Margin + RelativeMargin * (std::abs(places[0]) + std::abs(places[1]) + std::abs(begin));
      const double least = sign * (places[0] - slope * begin) - room;
      const bool isUseful = std::isfinite(least) && std::isfinite(slope);
      const double anything[3] = { 0.0, 0.0, 0.0 };
      this->SetSide(2 * other + upper, isUseful ? normal : anything, isUseful ? least : -1e300);
    }
  }
}

RayBeam::Cubes RayBeam::GetCubes(double edge) const
{
  Cubes cubes{};
  for (int axis = 0; axis < 3; ++axis)
  {
    constexpr double most = 1 << 30;
    cubes.First[axis] =
      static_cast<int>(std::clamp(std::floor(this->Lower[axis] / edge), 0.0, most));
    cubes.Last[axis] =
      static_cast<int>(std::clamp(std::floor(this->Upper[axis] / edge), -1.0, most));
  }
  for (int number = 0; number < 4; ++number)
  {
    const Side& side = this->Sides[number];
    // From a cube's lower corner to the one that is farthest inside.
    const double reach = edge *
      (std::max(side.Normal[0], 0.0) + std::max(side.Normal[1], 0.0) +
        std::max(side.Normal[2], 0.0));
    cubes.Least[number] = side.Least - reach;
    cubes.InverseX[number] = side.InverseX / edge;
  }
  return cubes;
}

} // namespace rt
