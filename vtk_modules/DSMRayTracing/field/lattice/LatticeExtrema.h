// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticeExtrema_h
#define rt_LatticeExtrema_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/BeamDescent.h"
#include "DSMRayTracing/field/lattice/ExtremumTest.h"
#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/lattice/LatticePackets.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"
#include "DSMRayTracing/field/lattice/TypedPacketBrick.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayExtrema.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace rt
{

/// Finds the largest or smallest value of a lattice that each ray of a batch meets, where cells hold data. A ray's
/// result does not depend on its packet. Threads and pins as IsosurfaceSearch.
template <class Store>
class LatticeExtrema
{
public:
  LatticeExtrema(Store& store, typename Store::Worker& worker,
    const PacketKernel& kernel = PacketKernel::GetBest())
    : Blocks(store)
    , Self(worker)
    , Kernel(kernel)
  {
  }

  /// See BeamFinder. `sign`, `limit`: see RayExtrema.
  static std::unique_ptr<ObjectBeam> FindBeam(
    const LatticeField& field, double sign, double limit, const Ray corners[4])
  {
    const ExtremumPredicate mayHold(sign, limit);
    return std::make_unique<BeamBricks>(FindBeamBricks(field, mayHold, corners));
  }

  /// See BeamFinder.
  bool Prefetch(const LatticeField& field, const ObjectBeam& beam, std::size_t count) const
  {
    return PrefetchFirst(this->Blocks, *field.Voxels->Segment, beam, count);
  }

  /// Looks for extrema beyond those that are known, along those of the rays that are `wanted`, in [ray.Min, ray.Max].
  /// `limit`: that of all rays at first. Returns the rays that have met the goal.
  RayMask Find(const LatticeField& field, double limit, ObjectBeam* beam, const Ray* rays,
    RayMask wanted, RayExtrema& extrema) const
  {
    return ForEachPacket(field, ExtremumPredicate(extrema.Sign, limit), this->Kernel,
      static_cast<BeamBricks*>(beam), rays, wanted,
      [&](BeamBricks& bricks, RayPacket& packet)
      { return this->FindInPacket(field, bricks, packet, extrema); });
  }

private:
  RayMask FindInPacket(
    const LatticeField& field, BeamBricks& bricks, RayPacket& packet, RayExtrema& extrema) const
  {
    const std::vector<bricks::ValueRange>& ranges = field.Voxels->Hierarchy.GetLevels()[0].Ranges;
    RayMask open = packet.Rays;
    bricks::Dispatch(field.Voxels->Lattice.GetScalarType(),
      [&](auto sample)
      {
        using T = decltype(sample);
        for (std::size_t place = 0; place < bricks.Bricks.size() && open != 0; ++place)
        {
          const BeamBricks::Brick& brick = bricks.Bricks[place];
          const RayMask improvable = FindRays(open,
            [&](int ray)
            { return ExtremumPredicate(extrema.Sign, extrema.Value[ray])(ranges[brick.Id]); });
          const RayMask meets = improvable == 0
            ? 0
            : this->Kernel.MeetBrick(packet, improvable, brick.Lower, brick.Upper);
          if (meets == 0)
          {
            continue;
          }
          bricks.Reached = std::max(bricks.Reached, place + 1);
          const typename Store::Pin pin =
            this->Blocks.Acquire(this->Self, *field.Voxels->Segment, brick.Id);
          const bricks::VoxelBrick<T> voxels(pin.GetData());
          const ExtremumTest<T> test(ExtremumPredicate(extrema.Sign, extrema.GetLeast(meets)));
          const TypedPacketBrick<T, ExtremumTest<T>> values(voxels, test, packet.Forward);
          open &= ~this->Kernel.FindExtrema(packet, meets, values, brick.Lower, extrema);
        }
      });
    return packet.Rays & ~open;
  }

  Store& Blocks;
  typename Store::Worker& Self;
  const PacketKernel& Kernel;
};

} // namespace rt

#endif
