// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleMesh_h
#define bricks_TriangleMesh_h

#include "DSMBricks/accel/BrickBvh.h"
#include "DSMBricks/layout/MeshAttributes.h"
#include "DSMCore/publish/BlockSegment.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>

namespace bricks
{

/// A mesh in bricks; shared by all that draw it. Everything but the segment's bytes is the same on
/// every rank.
struct TriangleMesh
{
  /// Positions in bricks are floats, in units of Scale, relative to this point of the mesh's space. It is 0 on an axis
  /// unless the mesh is small compared to its distance from 0; then it is near the mesh's middle and
  /// a multiple of a power of two no smaller than the mesh. Either way coordinates that came as
  /// floats are kept exactly, and doubles to 2^-22 of the mesh's size or better, wherever in the
  /// world it is.
  glm::dvec3 Origin{ 0.0 };
  /// 1 unless coordinates are so large that products of them leave the range of floats; then a power of two.
  double Scale = 1.0;
  /// In units of Scale, relative to Origin; Lower > Upper for a mesh without triangles.
  glm::dvec3 Lower{ 1.0 };
  glm::dvec3 Upper{ -1.0 };
  MeshAttributes Attributes;
  std::uint64_t Triangles = 0;
  /// Triangles of the input that no ray can hit: without area, or with a point that is not finite.
  std::uint64_t Dropped = 0;
  std::shared_ptr<dsm::BlockSegment> Segment;
  BrickBvh Bricks;
};

} // namespace bricks

#endif
