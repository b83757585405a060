// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticeMedia_h
#define rt_LatticeMedia_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/BeamDescent.h"
#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/lattice/LatticePackets.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"
#include "DSMRayTracing/field/lattice/TransferTest.h"
#include "DSMRayTracing/field/lattice/TypedPacketBrick.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>

namespace rt
{

/// Takes batches of rays through a medium whose values are a lattice's. A ray's result does not depend on its
/// packet. Threads and pins as IsosurfaceSearch.
template <class Store>
class LatticeMedia
{
public:
  LatticeMedia(Store& store, typename Store::Worker& worker,
    const PacketKernel& kernel = PacketKernel::GetBest())
    : Blocks(store)
    , Self(worker)
    , Kernel(kernel)
  {
  }

  /// See BeamFinder.
  std::unique_ptr<ObjectBeam> FindBeam(
    const LatticeField& field, const TransferFunction& function, const Ray corners[4]) const
  {
    const TransferPredicate mayHold(function);
    return std::make_unique<BeamBricks>(FindBeamBricks(field, mayHold, corners));
  }

  /// See BeamFinder.
  bool Prefetch(const LatticeField& field, const ObjectBeam& beam, std::size_t count) const
  {
    return PrefetchFirst(this->Blocks, *field.Voxels->Segment, beam, count);
  }

  /// See MediumTracer.
  RayMask March(const LatticeField& field, const TransferFunction& function, ObjectBeam* beam,
    const Ray* rays, RayMask wanted, MediumLight& light) const
  {
    return ForEachPacket(field, TransferPredicate(function), this->Kernel,
      static_cast<BeamBricks*>(beam), rays, wanted,
      [&](BeamBricks& bricks, RayPacket& packet)
      { return this->MarchPacket(field, function, bricks, packet, light); });
  }

private:
  RayMask MarchPacket(const LatticeField& field, const TransferFunction& function,
    BeamBricks& bricks, RayPacket& packet, MediumLight& light) const
  {
    RayMask open = packet.Rays;
    bricks::Dispatch(field.Voxels->Lattice.GetScalarType(),
      [&](auto sample)
      {
        using T = decltype(sample);
        for (std::size_t place = 0; place < bricks.Bricks.size() && open != 0; ++place)
        {
          const BeamBricks::Brick& brick = bricks.Bricks[place];
          const RayMask meets = this->Kernel.MeetBrick(packet, open, brick.Lower, brick.Upper);
          if (meets == 0)
          {
            continue;
          }
          bricks.Reached = std::max(bricks.Reached, place + 1);
          const typename Store::Pin pin =
            this->Blocks.Acquire(this->Self, *field.Voxels->Segment, brick.Id);
          const bricks::VoxelBrick<T> voxels(pin.GetData());
          const TransferTest<T> test(function, this->Kernel,
            light.WorldToSpace * glm::dmat3(field.IndexToWorld), field.Voxels->Planes.get(),
            brick.Lower);
          const TypedPacketBrick<T, TransferTest<T>> medium(voxels, test, packet.Forward);
          open &= ~this->Kernel.March(packet, meets, medium, brick.Lower, function, light);
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
