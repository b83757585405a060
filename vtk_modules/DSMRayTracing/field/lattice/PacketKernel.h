// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PacketKernel_h
#define rt_PacketKernel_h

#include "DSMBricks/base/Box.h"
#include "DSMRayTracing/field/grid/IndexSpace.h"
#include "DSMRayTracing/field/lattice/MacrocellKernel.h"
#include "DSMRayTracing/field/lattice/MediumBrick.h"
#include "DSMRayTracing/field/lattice/PacketBrick.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayExtrema.h"
#include "DSMRayTracing/ray/RayPacket.h"

#include <vector>

namespace rt
{

/// The steps of a packet that are done with the vector instructions of the processor, for as many
/// rays at once as its registers hold. There is one for each kind of processor in the same binary,
/// and one for rays one by one. All give the same bits, those of IndexSpace, GridRay, GridWalk, GridTraversal and
/// FindFirstCrossing: each ray's numbers come from the same operations, none of them contracted.
///
/// Pure; any thread.
struct PacketKernel
{
  const char* Name;
  int Width; ///< rays at once

  /// Makes the packet of those rays (world space) of `wanted` that cross the volume's `cells`, Forward
  /// being set. Returns those that do not fit into a packet.
  RayPacket::Mask (*SetRays)(RayPacket& packet, const Ray* rays, RayPacket::Mask wanted,
    const IndexSpace& space, const bricks::Index3& cells);

  /// Returns the subset of `rays` that cross a brick (planes in cells) within the volume, and sets where.
  RayPacket::Mask (*MeetBrick)(
    RayPacket& packet, RayPacket::Mask rays, const double lower[3], const double upper[3]);

  /// Finds the intersections of `rays` with the surface in their current brick. `origin` is the
  /// brick's first cell.
  void (*SearchBrick)(const RayPacket& packet, RayPacket::Mask rays, const PacketBrick& brick,
    const double origin[3], PacketHits& hits);

  /// Returns the subset of `rays` for which SearchBrick finds a hit.
  RayPacket::Mask (*FindOccluded)(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3]);

  /// Adds to `counts[ray]` how often each of `rays` meets the surface in the brick.
  void (*CountCrossings)(const RayPacket& packet, RayPacket::Mask rays, const PacketBrick& brick,
    const double origin[3], int* counts);

  /// Gives to `light` what a medium adds along `rays` in the brick that they are in. Returns those that are dark then.
  RayPacket::Mask (*March)(const RayPacket& packet, RayPacket::Mask rays, MediumBrick& brick,
    const double origin[3], const TransferFunction& function, MediumLight& light);

  /// Looks for the extrema of values along `rays` in the brick that they are in, whose corners have nothing subtracted.
  /// Returns those that have met the goal.
  RayPacket::Mask (*FindExtrema)(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], RayExtrema& extrema);

  /// For TypedPacketBrick.
  MacrocellKernel Macrocells;

  /// The fastest that this processor can run.
  static const PacketKernel& GetBest();
  /// All that this processor can run, that of width 1 first. For tests: not while any thread
  /// traces.
  static std::vector<PacketKernel> GetAll();
};

} // namespace rt

#endif
