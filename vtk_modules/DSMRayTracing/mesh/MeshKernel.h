// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshKernel_h
#define rt_MeshKernel_h

#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/layout/TriangleBrick.h"
#include "DSMRayTracing/mesh/MeshPacket.h"

#include <cstdint>
#include <vector>

namespace rt
{

/// The steps of a packet through the hierarchies of a mesh, with the vector instructions of the
/// processor, for as many rays at once as its registers hold. There is one for each kind of processor
/// in the same binary, and one for rays one by one. All find the same bits, those of
/// TreeletTraversal: rays are made by the same operations as ShearedRay, none of them contracted, and
/// beyond that vectors only tell which boxes need not be looked at.
///
/// Pure, but for what a visitor does; any thread.
struct MeshKernel
{
  /// Operation on a brick.
  class Visitor
  {
  public:
    virtual void Visit(std::uint32_t brick, MeshPacket::Mask rays) = 0;

  protected:
    ~Visitor() = default;
  };

  const char* Name;
  int Width; ///< rays at once

  /// Makes the packet of those rays of `wanted` (world space) that may meet the mesh, and returns them.
  MeshPacket::Mask (*SetRays)(
    MeshPacket& packet, const MeshInstance& instance, const Ray* rays, MeshPacket::Mask wanted);

  /// Visits the bricks whose boxes any of `rays` meet before their ends, about front to back. A visit
  /// may shorten rays.
  void (*FindBricks)(const MeshPacket& packet, MeshPacket::Mask rays,
    const bricks::BrickBvh& bricks, Visitor& visitor);

  /// Searches a brick. Returns those of `rays` for which it has a nearer hit than those so far, or
  /// one as near that comes first.
  MeshPacket::Mask (*SearchBrick)(MeshPacket& packet, MeshPacket::Mask rays,
    const bricks::TriangleBrick& brick, std::uint32_t number);

  /// Searches a brick for any hit. Returns those of `rays` that have one, and ends them.
  MeshPacket::Mask (*FindOccluded)(
    MeshPacket& packet, MeshPacket::Mask rays, const bricks::TriangleBrick& brick);

  /// The fastest that this processor can run.
  static const MeshKernel& GetBest();
  /// All that this processor can run, that of width 1 first. For tests: not while any thread
  /// traces.
  static std::vector<MeshKernel> GetAll();
};

} // namespace rt

#endif
