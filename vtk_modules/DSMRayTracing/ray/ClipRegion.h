// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ClipRegion_h
#define rt_ClipRegion_h

#include "DSMRayTracing/ray/Ray.h"

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
    glm::dvec3 Normal{ 0.0 }; ///< of any length
    glm::dvec3 Point{ 0.0 };
  };

  /// 3 x 3 x 3 boxes, of which the outer ones are infinite.
  struct Grid
  {
    glm::dmat4 WorldToGrid{ 1.0 }; ///< affine
    /// Where the boxes meet, in the grid's space.
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

  /// What is in all of them is kept.
  std::vector<HalfSpace> HalfSpaces;
  /// If set, and is in a box that is kept.
  std::optional<Grid> Boxes;

  bool KeepsAll() const { return this->HalfSpaces.empty() && !this->Boxes; }

  /// The parts of [ray.Min, ray.Max] that are kept, in order; returns how many. They reach over the
  /// borders by a few roundings, so that a surface that lies in a border is seen whole.
  int FindParts(const Ray& ray, Interval parts[MaxParts]) const;

  /// Calls `find(ray)` for each part, in order, until one says that it has found something; returns
  /// whether one has.
  template <class Find>
  bool FindFirst(const Ray& ray, Find&& find) const
  {
    if (this->KeepsAll())
    {
      return find(ray);
    }
    Interval parts[MaxParts];
    const int count = this->FindParts(ray, parts);
    for (int number = 0; number < count; ++number)
    {
      Ray part = ray;
      part.Min = parts[number].First;
      part.Max = parts[number].Last;
      if (find(part))
      {
        return true;
      }
    }
    return false;
  }
};

} // namespace rt

#endif
