// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TreeletTraversal_h
#define rt_TreeletTraversal_h

#include "DSMRayTracing/brick/TriangleBrick.h"
#include "DSMRayTracing/kernel/MeshInstance.h"
#include "DSMRayTracing/kernel/MeshRay.h"
#include "DSMRayTracing/kernel/NearestTriangle.h"
#include "DSMRayTracing/kernel/TriangleFilter.h"
#include "DSMRayTracing/kernel/WideBvhTraversal.h"

#include <cstdint>

namespace rt
{

/// Searches one brick with one ray.
class TreeletTraversal
{
public:
  /// `number`: of the brick.
  TreeletTraversal(const TriangleBrick& brick, std::uint32_t number, const MeshCulling& culling)
    : Brick(brick)
    , Number(number)
    , Culling(culling)
  {
  }

  /// Whether the brick has a nearer hit than those so far, or one as near that comes first. Hits
  /// shorten the ray.
  bool Intersect(MeshRay& ray, NearestTriangle& nearest) const
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

private:
  template <int Axis>
  bool IntersectAlong(MeshRay& ray, NearestTriangle& nearest) const
  {
    const FilterRay line(ray.Boxes.Origin, ray.FilterShear, ray.Uncertainty, this->Brick);
    bool better = false;
    TraverseWideBvh(this->Brick.GetNodes(), ray.Boxes, ray.BoxesEnd,
      [&](std::uint16_t reference)
      {
        const TriangleBrick::Leaf leaf(reference);
        const TriangleFilter<Axis> filter(this->Brick, leaf.First);
        unsigned candidates = filter.FindCandidates(line) & leaf.GetMask();
        for (; candidates != 0; candidates &= candidates - 1)
        {
          const auto lane = static_cast<std::uint32_t>(__builtin_ctz(candidates));
          if (nearest.Try(
                ray.Triangles, this->Culling, this->Brick, this->Number, leaf.First + lane))
          {
            ray.Shorten(nearest.Hit.T);
            better = true;
          }
        }
      });
    return better;
  }

  TriangleBrick Brick;
  std::uint32_t Number;
  MeshCulling Culling;
};

} // namespace rt

#endif
