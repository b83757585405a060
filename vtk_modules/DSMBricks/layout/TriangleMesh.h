// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleMesh_h
#define bricks_TriangleMesh_h

#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/layout/BrickSpace.h"
#include "DSMBricks/layout/MeshAttributes.h"
#include "DSMCore/publish/BlockSegment.h"

#include <cstdint>
#include <memory>

namespace bricks
{

/// A mesh in bricks; shared by all that draw it. Everything but the segment's bytes is the same on
/// every rank.
struct TriangleMesh : BrickSpace
{
  MeshAttributes Attributes;
  std::uint64_t Triangles = 0; ///< or tubes and spheres
  /// Those of the input that no ray can hit: without area or radius, or with a point that is not finite.
  std::uint64_t Dropped = 0;
  std::shared_ptr<dsm::BlockSegment> Segment;
  BrickBvh Bricks;
};

} // namespace bricks

#endif
