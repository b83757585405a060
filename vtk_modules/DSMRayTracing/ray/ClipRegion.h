// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ClipRegion_h
#define rt_ClipRegion_h

#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace rt
{

/// The part of space in which an object is shown; by default all of it. Where a ray enters and
/// leaves it depends on the ray and the region alone, so a clipped ray finds the same in packets and
/// by itself, on any rank.
class ClipRegion
{
public:
  /// World space; keeps the points p with dot(Normal, p - Point) >= 0.
  struct HalfSpace
  {
    glm::dvec3 Normal{ 0.0 }; ///< any length
    glm::dvec3 Point{ 0.0 };
  };

  /// 3 x 3 x 3 boxes, of which the outer ones are infinite.
  struct Grid
  {
    glm::dmat4 WorldToGrid{ 1.0 }; ///< affine
    /// Planes between the boxes, in the grid's space.
    glm::dvec3 Lower{ 0.0 };
    glm::dvec3 Upper{ 0.0 };
    std::uint32_t Kept = 0; ///< bit x + 3 y + 9 z
  };

  /// A part of a ray.
  struct Interval
  {
    double First;
    double Last;
  };

  /// A line crosses seven of the boxes at most.
  static constexpr int MaxParts = 4;

  /// Keeps the points that are in all of them.
  std::vector<HalfSpace> HalfSpaces;
  /// If set, and is in a box that is kept.
  std::optional<Grid> Boxes;

  bool KeepsAll() const { return this->HalfSpaces.empty() && !this->Boxes; }

  /// The parts of [ray.Min, ray.Max] that are kept, in order; returns how many. They reach over the
  /// borders by a few roundings, so that a surface that lies in a border is seen whole.
  int FindParts(const Ray& ray, Interval parts[MaxParts]) const;

  /// Searches what is kept of the `wanted` ones of a batch of rays: calls `search(rays, some)` for the
  /// first parts of the rays, then for the second ones of those that have not found anything, and so on;
  /// it returns those that have found something, as this does.
  template <class Search>
  RayMask SearchParts(const Ray* rays, RayMask wanted, const Search& search) const
  {
    if (this->KeepsAll())
    {
      return search(rays, wanted);
    }
    Interval intervals[MaxRays][MaxParts];
    int counts[MaxRays];
    Ray parts[MaxRays];
    ForEachRay(wanted,
      [&](int index)
      {
        counts[index] = this->FindParts(rays[index], intervals[index]);
        parts[index] = rays[index];
      });
    RayMask found = 0;
    RayMask left = wanted;
    for (int number = 0; number < MaxParts && left != 0; ++number)
    {
      left = FindRays(left & ~found, [&](int index) { return number < counts[index]; });
      ForEachRay(left,
        [&](int index)
        {
          parts[index].Min = intervals[index][number].First;
          parts[index].Max = intervals[index][number].Last;
        });
      found |= left != 0 ? search(parts, left) : 0;
    }
    return found;
  }
};

} // namespace rt

#endif
