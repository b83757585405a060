// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TreeletTraversal_h
#define rt_TreeletTraversal_h

#include "DSMRayTracing/brick/TriangleBrick.h"
#include "DSMRayTracing/kernel/MeshInstance.h"
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

  /// Whether the brick has a nearer hit than those so far, or one as near that comes first.
  bool Intersect(NearestTriangle& ray) const
  {
    switch (ray.Line.Axes[2])
    {
      case 0:
        return this->IntersectAlong<0>(ray);
      case 1:
        return this->IntersectAlong<1>(ray);
      default:
        return this->IntersectAlong<2>(ray);
    }
  }

private:
  template <int Axis>
  bool IntersectAlong(NearestTriangle& ray) const
  {
    const FilterRay line(ray.Line, this->Brick);
    bool better = false;
    TraverseWideBvh(this->Brick.GetNodes(), ray.Line.Boxes, ray.Line.BoxesEnd,
      [&](std::uint16_t reference)
      {
        const TriangleBrick::Leaf leaf(reference);
        const TriangleFilter<Axis> filter(this->Brick, leaf.First);
        unsigned candidates = filter.FindCandidates(line) & leaf.GetMask();
        for (; candidates != 0; candidates &= candidates - 1)
        {
          const auto lane = static_cast<std::uint32_t>(__builtin_ctz(candidates));
          better = ray.Try(this->Brick, this->Number, leaf.First + lane, this->Culling) || better;
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
