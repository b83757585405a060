// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TreeletTraversal_h
#define rt_TreeletTraversal_h

#include "DSMBricks/layout/TriangleBrick.h"
#include "DSMRayTracing/mesh/MeshInstance.h"
#include "DSMRayTracing/mesh/NearestTriangle.h"
#include "DSMRayTracing/mesh/TriangleFilter.h"
#include "DSMRayTracing/ray/ChildrenOnRay.h"
#include "DSMRayTracing/ray/ShearedRay.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

#include <cstdint>

namespace rt
{

/// Searches one brick with one ray.
class TreeletTraversal
{
public:
  /// `number`: of the brick.
  TreeletTraversal(
    const bricks::TriangleBrick& brick, std::uint32_t number, const MeshCulling& culling)
    : Brick(brick)
    , Number(number)
    , Culling(culling)
  {
  }

  /// Returns whether the brick has a nearer hit than those so far, or an equally near one that
  /// comes first. Hits shorten the ray.
  bool Intersect(ShearedRay& ray, NearestTriangle& nearest) const
  {
    switch (ray.Triangles.Axes[2])
    {
      case 0:
        return this->IntersectAlong<0>(ray, nearest);
      case 1:
        return this->IntersectAlong<1>(ray, nearest);
      default:
        return this->IntersectAlong<2>(ray, nearest);
    }
  }

  /// Returns whether the brick has any hit; if so, the ray ends.
  bool IsOccluded(ShearedRay& ray) const
  {
    switch (ray.Triangles.Axes[2])
    {
      case 0:
        return this->IsOccludedAlong<0>(ray);
      case 1:
        return this->IsOccludedAlong<1>(ray);
      default:
        return this->IsOccludedAlong<2>(ray);
    }
  }

private:
  template <int Axis>
  bool IsOccludedAlong(ShearedRay& ray) const
  {
    bool occluded = false;
    this->FindCandidates<Axis>(ray,
      [&](std::uint32_t triangle)
      {
        TriangleHit hit;
        if (!occluded &&
          NearestTriangle::Meets(ray.Triangles, this->Culling, this->Brick, triangle, hit))
        {
          occluded = true;
          ray.End();
        }
      });
    return occluded;
  }

  template <int Axis>
  bool IntersectAlong(ShearedRay& ray, NearestTriangle& nearest) const
  {
    bool better = false;
    this->FindCandidates<Axis>(ray,
      [&](std::uint32_t triangle)
      {
        if (nearest.Try(ray.Triangles, this->Culling, this->Brick, this->Number, triangle))
        {
          ray.Shorten(nearest.Hit.T);
          better = true;
        }
      });
    return better;
  }

  /// Calls `take(triangle)` for those that the ray may hit.
  template <int Axis, class Take>
  void FindCandidates(const ShearedRay& ray, Take&& take) const
  {
    const FilterRay line{ { ray.Boxes.Origin[0], ray.Boxes.Origin[1], ray.Boxes.Origin[2] },
      { ray.FilterShear[0], ray.FilterShear[1] },
      FilterRay::GetError(ray.Uncertainty, this->Brick) };
    TraverseWideBvh(this->Brick.GetNodes(), ChildrenOnRay(ray.Boxes, ray.BoxesEnd),
      [&](std::uint16_t reference)
      {
        const bricks::TriangleBrick::Leaf leaf(reference);
        const TriangleFilter<Axis> filter(this->Brick, leaf.First);
        unsigned candidates = filter.FindCandidates(line) & leaf.GetMask();
        for (; candidates != 0; candidates &= candidates - 1)
        {
          take(leaf.First + static_cast<std::uint32_t>(__builtin_ctz(candidates)));
        }
      });
  }

  bricks::TriangleBrick Brick;
  std::uint32_t Number;
  MeshCulling Culling;
};

} // namespace rt

#endif
