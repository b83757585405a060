// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelMedia_h
#define rt_LevelMedia_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"
#include "DSMRayTracing/field/lattice/TransferTest.h"
#include "DSMRayTracing/field/lattice/TypedPacketBrick.h"
#include "DSMRayTracing/field/levels/LevelPackets.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

namespace rt
{

/// Takes batches of rays through a medium whose values are those of levels. The counterpart of LatticeMedia. Bricks
/// of different levels may lie around one another, so the pieces that a ray meets are put in order before they
/// count.
template <class Store>
class LevelMedia
{
public:
  LevelMedia(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
    , Kernel(PacketKernel::GetBest())
    , Unsorted(std::make_unique<MediumLight>())
  {
  }

  /// See BeamFinder.
  std::unique_ptr<ObjectBeam> FindBeam(
    const LevelField& field, const TransferFunction& function, const Ray corners[4]) const
  {
    return std::make_unique<BeamBricks>(
      FindLevelBricks(field, TransferPredicate(function), corners));
  }

  /// See BeamFinder.
  bool Prefetch(const LevelField& field, const ObjectBeam& beam, std::size_t count) const
  {
    return PrefetchFirst(this->Blocks, *field.Voxels->Segment, beam, count);
  }

  /// See MediumTracer.
  RayMask March(const LevelField& field, const TransferFunction& function, ObjectBeam* beam,
    const Ray* rays, RayMask wanted, MediumLight& light) const
  {
    MediumLight& all = *this->Unsorted;
    all.Begin(rays, wanted);
    all.SetSpace(rays, wanted, light.WorldToSpace);
    all.KeepsPieces = true;
    all.DarkBelow = 0.0;
    // Pieces are joined when they are in order.
    ForEachRay(
      wanted, [&](int ray) { all.FirstPiece[ray] = std::numeric_limits<std::size_t>::max(); });
    ForEachLevelPacket(field, TransferPredicate(function), this->Kernel,
      static_cast<BeamBricks*>(beam), rays, wanted,
      [&](BeamBricks& bricks, LevelPackets& packets)
      {
        this->MarchPacket(field, function, bricks, packets, light.JoinedLength, all);
        return RayMask{ 0 };
      });
    return FindRays(wanted,
      [&](int ray)
      {
        std::vector<MediumPiece>& pieces = all.Pieces[ray];
        std::sort(pieces.begin(), pieces.end(),
          [](const MediumPiece& one, const MediumPiece& other) { return one.Begin < other.Begin; });
        for (const MediumPiece& piece : pieces)
        {
          if (light.IsDark(ray))
          {
            break;
          }
          light.Add(ray, piece);
        }
        return light.IsDark(ray);
      });
  }

private:
  /// `finestPiece`: length of a piece of the finest level that is described as one; 0: pieces are
  /// not described.
  void MarchPacket(const LevelField& field, const TransferFunction& function, BeamBricks& bricks,
    LevelPackets& packets, double finestPiece, MediumLight& light) const
  {
    const bricks::LevelLattice& lattice = field.Voxels->Lattice;
    const bricks::LevelScales& scales = lattice.GetScales();
    const double finest = scales.GetSize(scales.GetCount() - 1);
    bricks::DispatchSamples(lattice,
      [&](auto sample)
      {
        using T = decltype(sample);
        for (std::size_t place = 0; place < bricks.Bricks.size(); ++place)
        {
          const BeamBricks::Brick& brick = bricks.Bricks[place];
          const int level = lattice.GetBrick(brick.Id).Level;
          RayPacket& packet = packets.Get(level);
          const RayMask meets =
            this->Kernel.MeetBrick(packet, packet.Rays, brick.Lower, brick.Upper);
          if (meets == 0)
          {
            continue;
          }
          bricks.Reached = std::max(bricks.Reached, place + 1);
          const typename Store::Pin pin =
            this->Blocks.Acquire(this->Self, *field.Voxels->Segment, brick.Id);
          const bricks::VoxelBrick<T> voxels(pin.GetData());
          const glm::dvec3 scale(scales.Get(level));
          light.JoinedLength = finestPiece * scales.GetSize(level) / finest;
          glm::dmat3 axes = light.WorldToSpace * glm::dmat3(field.IndexToWorld);
          for (int axis = 0; axis < 3; ++axis)
          {
            axes[axis] /= scale[axis];
          }
          const TransferTest<T> test(function, this->Kernel, axes, nullptr, brick.Lower);
          const TypedPacketBrick<T, TransferTest<T>> medium(voxels, test, packet.Forward);
          this->Kernel.March(packet, meets, medium, brick.Lower, function, light);
        }
      });
  }

  Store& Blocks;
  typename Store::Worker& Self;
  const PacketKernel& Kernel;
  std::unique_ptr<MediumLight> Unsorted; ///< during March; kept for its memory
};

} // namespace rt

#endif
