// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_NearestTriangle_h
#define rt_NearestTriangle_h

#include "DSMRayTracing/brick/TriangleBrick.h"
#include "DSMRayTracing/kernel/MeshInstance.h"
#include "DSMRayTracing/kernel/MeshRay.h"
#include "DSMRayTracing/kernel/TriangleHit.h"
#include "DSMRayTracing/kernel/TriangleIntersector.h"

#include <cstdint>

namespace rt
{

/// The nearest hit of a ray among the triangles that were tried. What is found in the end does not
/// depend on the order in which they were; see ComesFirst.
struct NearestTriangle
{
  MeshRay Line; ///< shortened by every hit
  TriangleHit Hit;
  bool Found = false;

  /// Whether a triangle of a brick is the nearest so far.
  bool Try(const TriangleBrick& brick, std::uint32_t number, std::uint32_t triangle,
    const MeshCulling& culling)
  {
    const TriangleBrickVertex* vertices = brick.GetVertices();
    const std::uint16_t* corners = brick.GetTriangle(triangle);
    TriangleHit hit;
    hit.Brick = number;
    hit.Triangle = triangle;
    if (!IntersectTriangle(this->Line, vertices[corners[0]].Position, vertices[corners[1]].Position,
          vertices[corners[2]].Position, hit) ||
      (hit.Front ? culling.Front : culling.Back) ||
      (this->Found && hit.T == this->Hit.T && !ComesFirst(hit, this->Hit)))
    {
      return false;
    }
    this->Hit = hit;
    this->Found = true;
    this->Line.Shorten(hit.T);
    return true;
  }
};

} // namespace rt

#endif
