// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/ray/ClipRegion.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>

namespace rt
{

namespace
{

/// A surface in a border must not be lost to the rounding of where a ray meets the one and the other.
constexpr double ClipRounding = 1e-12;

double GetTolerance(double t)
{
  return ClipRounding * (1.0 + std::abs(t));
}

/// Moves the ends that are borders outwards.
void Widen(const Ray& ray, ClipRegion::Interval& part)
{
  part.First = std::max(ray.Min, part.First - GetTolerance(part.First));
  part.Last = std::min(ray.Max, part.Last + GetTolerance(part.Last));
}

/// Shortens the part to what the half space keeps; false when nothing is left.
bool Clip(const Ray& ray, const ClipRegion::HalfSpace& half, ClipRegion::Interval& part)
{
  const double slope = glm::dot(half.Normal, ray.Direction);
  const double height = glm::dot(half.Normal, ray.Origin - half.Point);
  if (slope == 0.0)
  {
    return height >= 0.0;
  }
  const double t = -height / slope;
  if (slope > 0.0)
  {
    part.First = std::max(part.First, t);
  }
  else
  {
    part.Last = std::min(part.Last, t);
  }
  return part.First <= part.Last;
}

/// A ray through the boxes of a grid.
class GridLine
{
public:
  GridLine(const ClipRegion::Grid& grid, const Ray& ray)
    : Grid(grid)
    , Origin(grid.WorldToGrid * glm::dvec4(ray.Origin, 1.0))
    , Direction(glm::dmat3(grid.WorldToGrid) * ray.Direction)
  {
  }

  /// Finds the T, ascending, at which the ray goes from one box to another within a part; returns
  /// their number.
  int FindBorders(const ClipRegion::Interval& part, double borders[6]) const
  {
    int count = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      for (const double plane : { this->Grid.Lower[axis], this->Grid.Upper[axis] })
      {
        const double t = (plane - this->Origin[axis]) / this->Direction[axis];
        if (t > part.First && t < part.Last)
        {
          // At most six: the next one goes where it belongs.
          int place = count++;
          for (; place > 0 && borders[place - 1] > t; --place)
          {
            borders[place] = borders[place - 1];
          }
          borders[place] = t;
        }
      }
    }
    return count;
  }

  /// Returns whether the box that the ray crosses in a part is kept.
  bool IsKept(const ClipRegion::Interval& part) const
  {
    const double middle =
      std::isfinite(part.Last) ? 0.5 * (part.First + part.Last) : part.First + 1.0;
    int box = 0;
    int stride = 1;
    for (int axis = 0; axis < 3; ++axis, stride *= 3)
    {
      const double place = this->Origin[axis] + middle * this->Direction[axis];
      box +=
        stride * (int{ place >= this->Grid.Lower[axis] } + int{ place > this->Grid.Upper[axis] });
    }
    return (this->Grid.Kept >> box & 1u) != 0;
  }

private:
  const ClipRegion::Grid& Grid;
  glm::dvec3 Origin;
  glm::dvec3 Direction;
};

} // namespace

int ClipRegion::FindParts(const Ray& ray, Interval parts[MaxParts]) const
{
  Interval whole{ ray.Min, ray.Max };
  for (const HalfSpace& half : this->HalfSpaces)
  {
    if (!Clip(ray, half, whole))
    {
      return 0;
    }
  }
  if (!this->Boxes)
  {
    parts[0] = whole;
    Widen(ray, parts[0]);
    return 1;
  }
  const GridLine line(*this->Boxes, ray);
  double borders[7];
  const int count = line.FindBorders(whole, borders);
  borders[count] = whole.Last;
  int found = 0;
  bool continues = false;
  Interval part{ whole.First, whole.First };
  for (int number = 0; number <= count; ++number)
  {
    part = { part.Last, borders[number] };
    const bool kept = line.IsKept(part);
    if (kept && continues)
    {
      // Boxes that touch leave no seam.
      parts[found - 1].Last = part.Last;
    }
    else if (kept)
    {
      parts[found++] = part;
    }
    continues = kept;
  }
  for (int number = 0; number < found; ++number)
  {
    Widen(ray, parts[number]);
  }
  return found;
}

} // namespace rt
