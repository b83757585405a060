// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelExtrema_h
#define rt_LevelExtrema_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/lattice/ExtremumTest.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"
#include "DSMRayTracing/field/lattice/TypedPacketBrick.h"
#include "DSMRayTracing/field/levels/LevelPackets.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayExtrema.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace rt
{

/// Finds the largest or smallest value of levels that each ray of a batch meets. The counterpart of LatticeExtrema.
template <class Store>
class LevelExtrema
{
public:
  LevelExtrema(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
    , Kernel(PacketKernel::GetBest())
  {
  }

  /// See BeamFinder. `sign`, `limit`: see RayExtrema.
  static std::unique_ptr<ObjectBeam> FindBeam(
    const LevelField& field, double sign, double limit, const Ray corners[4])
  {
    return std::make_unique<BeamBricks>(
      FindLevelBricks(field, ExtremumPredicate(sign, limit), corners));
  }

  /// See BeamFinder.
  bool Prefetch(const LevelField& field, const ObjectBeam& beam, std::size_t count) const
  {
    return PrefetchFirst(this->Blocks, *field.Voxels->Segment, beam, count);
  }

  /// See LatticeExtrema.
  RayMask Find(const LevelField& field, double limit, ObjectBeam* beam, const Ray* rays,
    RayMask wanted, RayExtrema& extrema) const
  {
    return ForEachLevelPacket(field, ExtremumPredicate(extrema.Sign, limit), this->Kernel,
      static_cast<BeamBricks*>(beam), rays, wanted,
      [&](BeamBricks& bricks, LevelPackets& packets)
      { return this->FindInPacket(field, bricks, packets, extrema); });
  }

private:
  RayMask FindInPacket(
    const LevelField& field, BeamBricks& bricks, LevelPackets& packets, RayExtrema& extrema) const
  {
    const bricks::LevelVoxels& voxels = *field.Voxels;
    // Which of equal values a ray finds depends on the order of bricks, so that must not depend on the packet.
    std::vector<std::size_t> order(bricks.Bricks.size());
    for (std::size_t place = 0; place < order.size(); ++place)
    {
      order[place] = place;
    }
    std::sort(order.begin(), order.end(),
      [&](std::size_t one, std::size_t other)
      { return bricks.Bricks[one].Id < bricks.Bricks[other].Id; });
    RayMask open = packets.GetCoarsest().Rays;
    bricks::DispatchSamples(voxels.Lattice,
      [&](auto sample)
      {
        using T = decltype(sample);
        for (const std::size_t place : order)
        {
          const BeamBricks::Brick& brick = bricks.Bricks[place];
          const bricks::ValueRange& range = voxels.Hierarchy.GetRange(brick.Id);
          const RayMask improvable = FindRays(open,
            [&](int ray) { return ExtremumPredicate(extrema.Sign, extrema.Value[ray])(range); });
          RayPacket& packet = packets.Get(voxels.Lattice.GetBrick(brick.Id).Level);
          const RayMask meets = improvable == 0
            ? 0
            : this->Kernel.MeetBrick(packet, improvable, brick.Lower, brick.Upper);
          if (meets == 0)
          {
            continue;
          }
          bricks.Reached = std::max(bricks.Reached, place + 1);
          const typename Store::Pin pin =
            this->Blocks.Acquire(this->Self, *voxels.Segment, brick.Id);
          const bricks::VoxelBrick<T> samples(pin.GetData());
          const ExtremumTest<T> test(ExtremumPredicate(extrema.Sign, extrema.GetLeast(meets)));
          const TypedPacketBrick<T, ExtremumTest<T>> values(samples, test, packet.Forward);
          open &= ~this->Kernel.FindExtrema(packet, meets, values, brick.Lower, extrema);
        }
      });
    return packets.GetCoarsest().Rays & ~open;
  }

  Store& Blocks;
  typename Store::Worker& Self;
  const PacketKernel& Kernel;
};

} // namespace rt

#endif
