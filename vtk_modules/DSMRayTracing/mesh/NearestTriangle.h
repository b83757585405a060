// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_NearestTriangle_h
#define rt_NearestTriangle_h

#include "DSMBricks/layout/TriangleBrick.h"
#include "DSMRayTracing/mesh/MeshInstance.h"
#include "DSMRayTracing/mesh/TriangleHit.h"
#include "DSMRayTracing/mesh/TriangleIntersector.h"
#include "DSMRayTracing/mesh/TubeIntersector.h"
#include "DSMRayTracing/ray/TriangleRay.h"

#include <cstdint>

namespace rt
{

/// The nearest hit of a ray among the triangles that were tried. The final hit does not depend on their order; see
/// ComesFirst.
struct NearestTriangle
{
  TriangleHit Hit;
  bool Found = false;

  /// Returns whether a ray intersects a triangle of a brick, or a tube, and sets `hit`.
  static bool Meets(const TriangleRay& ray, const MeshCulling& culling,
    const bricks::TriangleBrick& brick, std::uint32_t triangle, TriangleHit& hit)
  {
    const bricks::TriangleBrickVertex* vertices = brick.GetVertices();
    const std::uint16_t* corners = brick.GetTriangle(triangle);
    if (brick.GetHeader().Radii)
    {
      return IntersectTube(
        ray, culling, vertices[corners[0]], vertices[corners[1]], vertices[corners[2]], hit);
    }
    return IntersectTriangle(ray, vertices[corners[0]].Position, vertices[corners[1]].Position,
             vertices[corners[2]].Position, hit) &&
      !(hit.Front ? culling.Front : culling.Back);
  }

  /// Returns whether a triangle of a brick is the nearest so far. If so, the ray ends there: the
  /// caller has to lower ray.Max to Hit.T.
  bool Try(const TriangleRay& ray, const MeshCulling& culling, const bricks::TriangleBrick& brick,
    std::uint32_t number, std::uint32_t triangle)
  {
    TriangleHit hit;
    hit.Brick = number;
    hit.Triangle = triangle;
    return Meets(ray, culling, brick, triangle, hit) && this->Take(hit);
  }

  /// The same for an intersection up to ray.Max.
  bool Take(const TriangleHit& hit)
  {
    if (this->Found && hit.T == this->Hit.T && !ComesFirst(hit, this->Hit))
    {
      return false;
    }
    this->Hit = hit;
    this->Found = true;
    return true;
  }
};

} // namespace rt

#endif
