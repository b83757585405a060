// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TreeletTraversal_h
#define rt_TreeletTraversal_h

#include "DSMRayTracing/brick/TriangleBrick.h"
#include "DSMRayTracing/kernel/MeshInstance.h"
#include "DSMRayTracing/kernel/MeshRay.h"
#include "DSMRayTracing/kernel/TriangleFilter.h"
#include "DSMRayTracing/kernel/TriangleHit.h"
#include "DSMRayTracing/kernel/TriangleIntersector.h"
#include "DSMRayTracing/kernel/WideBvhTraversal.h"

#include <cstdint>

namespace rt
{

/// The nearest hit of a ray among what it met before and the triangles of a brick.
class TreeletTraversal
{
public:
  /// `ray` is shortened by every hit.
  TreeletTraversal(MeshRay& ray, const MeshCulling& culling)
    : Line(ray)
    , Culling(culling)
  {
  }

  /// Whether the brick has a nearer hit than those so far, or one as near that comes first.
  bool Intersect(const TriangleBrick& brick)
  {
    switch (this->Line.Axes[2])
    {
      case 0:
        return this->IntersectAlong<0>(brick);
      case 1:
        return this->IntersectAlong<1>(brick);
      default:
        return this->IntersectAlong<2>(brick);
    }
  }

  bool HasHit() const { return this->Found; }
  const TriangleHit& GetHit() const { return this->Nearest; }

private:
  template <int Axis>
  bool IntersectAlong(const TriangleBrick& brick)
  {
    const TriangleFilter<Axis> filter(this->Line, brick);
    bool better = false;
    TraverseWideBvh(brick.GetNodes(), this->Line.Boxes, this->Line.BoxesEnd,
      [&](std::uint16_t leaf)
      {
        const std::uint32_t first = leaf & 0x1fffu;
        const std::uint32_t count = (leaf >> 13 & 3u) + 1;
        unsigned candidates = filter.FindCandidates(first) & ((1u << count) - 1u);
        while (candidates != 0)
        {
          const auto lane = static_cast<std::uint32_t>(__builtin_ctz(candidates));
          candidates &= candidates - 1;
          better = this->Try(brick, first + lane) || better;
        }
      });
    return better;
  }

  bool Try(const TriangleBrick& brick, std::uint32_t triangle)
  {
    const TriangleBrickVertex* vertices = brick.GetVertices();
    const std::uint16_t* corners = brick.GetTriangle(triangle);
    TriangleHit hit;
    if (!IntersectTriangle(this->Line, vertices[corners[0]].Position, vertices[corners[1]].Position,
          vertices[corners[2]].Position, hit) ||
      (hit.Front ? this->Culling.Front : this->Culling.Back) ||
      (this->Found && hit.T == this->Nearest.T && !ComesFirst(hit, this->Nearest)))
    {
      return false;
    }
    hit.Triangle = triangle;
    this->Nearest = hit;
    this->Found = true;
    this->Line.Shorten(hit.T);
    return true;
  }

  MeshRay& Line;
  MeshCulling Culling;
  TriangleHit Nearest;
  bool Found = false;
};

} // namespace rt

#endif
