// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VoxelExtrema_h
#define rt_VoxelExtrema_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/lattice/ExtremumTest.h"
#include "DSMRayTracing/field/lattice/TypedPacketBrick.h"
#include "DSMRayTracing/field/lattice/VoxelSearch.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayExtrema.h"

#include <algorithm>
#include <cstddef>
#include <memory>

namespace rt
{

/// Finds the largest or smallest value of a field that each ray of a batch meets, where cells hold data.
template <class FieldType, class Store>
class VoxelExtrema : public VoxelSearch<FieldType, Store>
{
public:
  using VoxelSearch<FieldType, Store>::VoxelSearch;

  /// See BeamFinder. `sign`, `limit`: see RayExtrema.
  static std::unique_ptr<ObjectBeam> FindBeam(
    const FieldType& field, double sign, double limit, const Ray corners[4])
  {
    return VoxelExtrema::FindBricks(field, ExtremumPredicate(sign, limit), corners);
  }

  /// Looks for extrema beyond those that are known, along those of the rays that are `wanted`, in [ray.Min, ray.Max].
  /// `limit`: that of all rays at first. Returns the rays that have met the goal.
  RayMask Find(const FieldType& field, double limit, ObjectBeam* beam, const Ray* rays,
    RayMask wanted, RayExtrema& extrema) const
  {
    return ForEachPacket(field, ExtremumPredicate(extrema.Sign, limit), this->Kernel,
      static_cast<BeamBricks*>(beam), rays, wanted,
      [&](BeamBricks& bricks, auto& packets)
      { return this->FindInPacket(field, bricks, packets, extrema); });
  }

private:
  /// `packets`: LatticePackets or LevelPackets.
  template <class Packets>
  RayMask FindInPacket(
    const FieldType& field, BeamBricks& bricks, Packets& packets, RayExtrema& extrema) const
  {
    const RayMask all = packets.GetCoarsest().Rays;
    RayMask open = all;
    VoxelExtrema::Dispatch(field,
      [&](auto sample)
      {
        using T = decltype(sample);
        for (const std::size_t place : packets.GetOrder(bricks))
        {
          const BeamBricks::Brick& brick = bricks.Bricks[place];
          const bricks::ValueRange& range = packets.GetRange(brick.Id);
          const RayMask improvable = FindRays(open,
            [&](int ray) { return ExtremumPredicate(extrema.Sign, extrema.Value[ray])(range); });
          if (improvable == 0)
          {
            continue;
          }
          RayPacket& packet = packets.Get(brick.Id);
          const RayMask meets =
            this->Kernel.MeetBrick(packet, improvable, brick.Lower, brick.Upper);
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
    return all & ~open;
  }
};

} // namespace rt

#endif
