// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_RoundCone_h
#define rt_RoundCone_h

#include "DSMBricks/layout/TriangleBrickHeader.h"
#include "DSMRayTracing/ray/TriangleRay.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace rt
{

/// A ray for tests of balls and round cones: positions along the axes of a TriangleRay. Its longest component of the
/// direction is 1 or -1, so that a place on it is at a T of itself times TPerUnit.
struct BallRay
{
  explicit BallRay(const TriangleRay& ray)
    : Axes(ray.Axes)
    , Origin(ray.Origin[0], ray.Origin[1], ray.Origin[2])
    , Direction(ray.Shear[0], ray.Shear[1], 1.0)
    , TPerUnit(std::abs(ray.Shear[2]))
  {
    this->Direction *= ray.Shear[2] < 0.0 ? -1.0 : 1.0;
    this->PerSquare = 1.0 / glm::dot(this->Direction, this->Direction);
  }

  glm::dvec3 GetPosition(const bricks::TriangleBrickVertex& vertex) const
  {
    const float* position = vertex.Position;
    return { position[this->Axes[0]], position[this->Axes[1]], position[this->Axes[2]] };
  }
  /// The position of a vertex, relative to the ray's origin.
  glm::dvec3 GetCenter(const bricks::TriangleBrickVertex& vertex) const
  {
    return this->GetPosition(vertex) - this->Origin;
  }
  /// The place nearest to a point relative to the origin.
  double GetNearest(const glm::dvec3& point) const
  {
    return glm::dot(point, this->Direction) * this->PerSquare;
  }

  const int* Axes;
  glm::dvec3 Origin;
  glm::dvec3 Direction;
  double TPerUnit;
  double PerSquare; ///< the reciprocal of the direction's length, squared
};

/// Part of a line inside a ball or a round cone. Both are convex: there is one, or none.
struct ConeSpan
{
  bool Found = false;
  double Enter = HUGE_VAL;
  double Leave = -HUGE_VAL;
  /// The surface is where balls touch it whose centers are on the way from the first end, 0, to the second one, 1.
  double EnterBall = 0.0;
  double LeaveBall = 0.0;

  void Add(double place, double ball)
  {
    this->Found = true;
    if (place < this->Enter)
    {
      this->Enter = place;
      this->EnterBall = ball;
    }
    if (place > this->Leave)
    {
      this->Leave = place;
      this->LeaveBall = ball;
    }
  }

  /// Adds a ball. The same ball has the same places, bit for bit, in every cone that ends with it.
  void AddBall(const BallRay& ray, const bricks::TriangleBrickVertex& vertex, double ball)
  {
    // From the place nearest to the center: no digits are lost for a small ball far away (Haines et al.,
    // Ray Tracing Gems 2019, chapter 7).
    const glm::dvec3 center = ray.GetCenter(vertex);
    const double nearest = ray.GetNearest(center);
    const glm::dvec3 beside = center - nearest * ray.Direction;
    const double radius = vertex.GetRadius();
    const double square = radius * radius - glm::dot(beside, beside);
    if (square >= 0.0)
    {
      const double half = std::sqrt(square * ray.PerSquare);
      this->Add(nearest - half, ball);
      this->Add(nearest + half, ball);
    }
  }
};

/// Intersects a line with a round cone: the hull of the balls at two vertices.
///
/// A point x is on the side of the cone where Q(x) = 0, and the ball that touches the side there is between the two:
/// Q(x) = min over s of |x - a - s d|^2 - (r + s e)^2. Here d leads from the first center a to the second one, r is the
/// first radius, e is the difference of the radii, and s is the ball. Along the line, Q is quadratic and s is linear.
///
/// The equation starts from the place nearest to the middle of the axis, and is split into parts along the axis and
/// across it: a cone that is thin, long or far away keeps its digits. The line enters at the first of all its points
/// on the side and on the two balls, and leaves at the last one. All are points of one convex surface, so rounding
/// errors at the border between side and ball make no hole.
inline ConeSpan IntersectRoundCone(const BallRay& ray, const bricks::TriangleBrickVertex& first,
  const bricks::TriangleBrickVertex& second)
{
  // Where the smaller ball reaches out of the larger one by no more than the rounding of corners, it is left out.
  constexpr double smallestPart = 0x1p-24;
  ConeSpan span;
  const double radius = first.GetRadius();
  const double more = second.GetRadius() - radius;
  const glm::dvec3 start = ray.GetCenter(first);
  const glm::dvec3 axis = ray.GetPosition(second) - ray.GetPosition(first);
  const double square = glm::dot(axis, axis);
  const double side = square - more * more;
  if (!(side > smallestPart * square))
  {
    const bool isSecond = more > 0.0;
    span.AddBall(ray, isSecond ? second : first, isSecond ? 1.0 : 0.0);
    return span;
  }
  const double perSquare = 1.0 / square;
  const double perSide = 1.0 / side;
  const double near = ray.GetNearest(start + 0.5 * axis);
  const glm::dvec3 offset = near * ray.Direction - start;
  const double along = glm::dot(offset, axis);
  const double slope = glm::dot(ray.Direction, axis);
  const glm::dvec3 across = offset - along * perSquare * axis;
  const glm::dvec3 acrossSlope = ray.Direction - slope * perSquare * axis;
  const double radiusThere = radius + more * (along * perSquare);
  const double a =
    glm::dot(acrossSlope, acrossSlope) - slope * slope * (more * more * perSquare * perSide);
  const double b = glm::dot(across, acrossSlope) - slope * more * perSide * radiusThere;
  const double c = glm::dot(across, across) - radiusThere * radiusThere * (square * perSide);
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0 && a > 0.0)
  {
    return span; // also the balls lie inside the cone that the line misses
  }
  if (discriminant >= 0.0)
  {
    const double both = -(b + std::copysign(std::sqrt(discriminant), b));
    for (const double root : { both / a, c / both })
    {
      const double ball = (along + more * radius + slope * root) * perSide;
      if (ball >= 0.0 && ball <= 1.0)
      {
        span.Add(near + root, ball);
      }
    }
  }
  // Between two points of the side, all is inside where the cone does not open faster than the line runs.
  const bool isComplete = a > 0.0 && span.Leave > span.Enter;
  if (!isComplete)
  {
    span.AddBall(ray, first, 0.0);
    span.AddBall(ray, second, 1.0);
  }
  return span;
}

} // namespace rt

#endif
