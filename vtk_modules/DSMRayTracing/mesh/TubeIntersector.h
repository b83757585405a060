// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TubeIntersector_h
#define rt_TubeIntersector_h

#include "DSMBricks/layout/TriangleBrickHeader.h"
#include "DSMRayTracing/mesh/MeshInstance.h"
#include "DSMRayTracing/mesh/TriangleHit.h"
#include "DSMRayTracing/ray/TriangleRay.h"

namespace rt
{

/// Intersects a ray with the part of a tube that belongs to the point `middle`, or with a sphere; see
/// bricks::TriangleSource. The same vertex is the same object.
///
/// All hits are where the ray enters the union of two round cones, or leaves it. A place on the half of a cone that
/// belongs to another point is that one's, and told from the same numbers there. A place between those where the
/// ray enters and leaves the other cone is inside the tube and no hit. Both only compare places on the ray, so that no
/// hit is lost where two cones meet: if a ray enters one cone inside another, it has entered that before. Cones that
/// are not next to each other do not know of each other: where a line turns back within its own thickness, and where
/// lines cross, the ray also meets the surfaces inside.
///
/// Finds the nearest hit in [ray.Min, ray.Max] on a side that is not culled. The weights are those of the ball that
/// touches the surface there: from its center, the normal points to the hit. Fills in all of the hit but Brick and
/// Triangle. Not inline: all callers get the same bits. Cold: the call is kept out of the way of triangles.
[[gnu::cold]] bool IntersectTube(const TriangleRay& ray, const MeshCulling& culling,
  const bricks::TriangleBrickVertex& before, const bricks::TriangleBrickVertex& middle,
  const bricks::TriangleBrickVertex& behind, TriangleHit& hit);

} // namespace rt

#endif
