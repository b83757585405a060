// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelSurfaces_txx
#define rt_LevelSurfaces_txx

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/grid/HitGradient.h"
#include "DSMRayTracing/field/grid/IsovalueLevel.h"
#include "DSMRayTracing/field/lattice/IsovalueTest.h"
#include "DSMRayTracing/field/lattice/TypedPacketBrick.h"
#include "DSMRayTracing/field/levels/LevelPackets.h"
#include "DSMRayTracing/look/SheetTransmittance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rt
{

/// The first hits of the rays of a packet so far.
template <class Store>
struct LevelSurfaces<Store>::Nearest
{
  RayMask Found = 0;
  CellHit Cells[RayPacket::Size];
  int Isovalue[RayPacket::Size];
  dsm::BlockId Brick[RayPacket::Size];
  RayMask WithoutGradient = 0;
  glm::dvec3 Gradient[RayPacket::Size]; ///< in the index space of level 0

  /// Returns whether a hit comes before the one so far. The choice among equally near hits does not depend on the
  /// order of bricks.
  bool IsNearer(int ray, double t, int isovalue, dsm::BlockId brick) const
  {
    if ((this->Found & GetBit(ray)) == 0)
    {
      return true;
    }
    const double known = this->Cells[ray].T;
    return t < known ||
      (t == known &&
        (isovalue < this->Isovalue[ray] ||
          (isovalue == this->Isovalue[ray] && brick < this->Brick[ray])));
  }
};

template <class Store>
std::unique_ptr<ObjectBeam> LevelSurfaces<Store>::FindBeam(
  const Sets& sets, const Ray corners[4]) const
{
  return std::make_unique<BeamBricks>(
    FindBeamBricks(sets.Field, IsovaluePredicate(sets.Isovalues), corners));
}

template <class Store>
bool LevelSurfaces<Store>::Prefetch(
  const Sets& sets, const ObjectBeam& beam, std::size_t count) const
{
  return PrefetchFirst(this->Blocks, *sets.Field.Voxels->Segment, beam, count);
}

template <class Store>
template <class T, class IsOpen, class Search>
void LevelSurfaces<Store>::SearchBricks(const Sets& sets, BeamBricks& bricks, LevelPackets& packets,
  const IsOpen& isOpen, const Search& search) const
{
  const bricks::LevelVoxels& field = *sets.Field.Voxels;
  for (std::size_t place = 0; place < bricks.Bricks.size(); ++place)
  {
    const BeamBricks::Brick& brick = bricks.Bricks[place];
    RayPacket& packet = packets.Get(brick.Id);
    RayMask open = this->Kernel.MeetBrick(packet, packet.Rays, brick.Lower, brick.Upper);
    open = open == 0 ? 0 : isOpen(packet, open);
    if (open == 0)
    {
      continue;
    }
    bricks.Reached = std::max(bricks.Reached, place + 1);
    const typename Store::Pin pin = this->Blocks.Acquire(this->Self, *field.Segment, brick.Id);
    const bricks::VoxelBrick<T> voxels(pin.GetData());
    const bricks::ValueRange range{ voxels.GetHeader().First, voxels.GetHeader().Last };
    for (std::size_t index = 0; index < sets.Isovalues.size(); ++index)
    {
      if (range.MayHold(sets.Isovalues[index]))
      {
        const IsovalueLevel<T> level(sets.Isovalues[index]);
        const IsovalueTest<T> test(level, this->Kernel.Macrocells.template Get<T>());
        TypedPacketBrick<T, IsovalueTest<T>> surface(voxels, test, packet.Forward);
        surface.Border = { voxels.GetHeader().Borders, sets.Isovalues[index],
          std::numeric_limits<T>::epsilon() * (sizeof(T) == 4 ? 1.0 : 16.0),
          std::max(std::abs(static_cast<double>(range.First)),
            std::abs(static_cast<double>(range.Last))) };
        search(packet, open, index, surface, brick, voxels, level);
      }
    }
  }
}

template <class Store>
template <class Open>
RayMask LevelSurfaces<Store>::Intersect(
  const Sets& sets, ObjectBeam* beam, const Ray* rays, RayMask wanted, const Open& open) const
{
  const bricks::LevelVoxels& field = *sets.Field.Voxels;
  const IsovaluePredicate mayHold(sets.Isovalues);
  return ForEachPacket(sets.Field, mayHold, this->Kernel, static_cast<BeamBricks*>(beam), rays,
    wanted,
    [&](BeamBricks& bricks, LevelPackets& packets)
    {
      Nearest nearest;
      bricks::DispatchSamples(field.Lattice,
        [&](auto sample)
        {
          this->SearchBricks<decltype(sample)>(
            sets, bricks, packets,
            [&](const RayPacket& packet, RayMask meets)
            {
              return FindRays(meets,
                [&](int ray) {
                  return (nearest.Found & GetBit(ray)) == 0 ||
                    packet.BrickEnter[ray] <= nearest.Cells[ray].T;
                });
            },
            [&](const RayPacket& packet, RayMask some, std::size_t isovalue,
              const PacketBrick& surface, const BeamBricks::Brick& brick, const auto& voxels,
              const auto& level)
            {
              PacketHits candidates;
              this->Kernel.SearchBrick(packet, some, surface, brick.Lower, candidates);
              for (int number = 0; number < candidates.Count; ++number)
              {
                const int ray = candidates.Ray[number];
                if (!nearest.IsNearer(
                      ray, candidates.T[number], static_cast<int>(isovalue), brick.Id))
                {
                  continue;
                }
                nearest.Found |= GetBit(ray);
                nearest.Cells[ray] = candidates.Get(number);
                nearest.Isovalue[ray] = static_cast<int>(isovalue);
                nearest.Brick[ray] = brick.Id;
                const CellHit& cell = nearest.Cells[ray];
                GradientStencil stencil;
                const bool within = HitGradient::FillWithin(voxels, cell, level, stencil) &&
                  stencil.GetGradient(cell.Local, UnitSteps(), &nearest.Gradient[ray].x);
                nearest.WithoutGradient &= ~GetBit(ray);
                nearest.WithoutGradient |= GetBit(ray, !within);
                const int ofBrick = field.Lattice.GetBrick(brick.Id).Level;
                nearest.Gradient[ray] *= glm::dvec3(field.Lattice.GetScales().Get(ofBrick));
              }
            });
        });
      const IndexSpace space = sets.Field.GetIndexSpace();
      ForEachRay(nearest.Found,
        [&](int ray)
        {
          const CellHit& cell = nearest.Cells[ray];
          Hit* const hit = open(ray, cell.T);
          if (!hit)
          {
            return;
          }
          const bricks::Index3& first = field.Lattice.GetBrick(nearest.Brick[ray]).Cells.Min;
          hit->T = cell.T;
          hit->Isovalue = nearest.Isovalue[ray];
          hit->FromInside = cell.FromInside;
          hit->At.Brick = nearest.Brick[ray];
          hit->At.Cell = glm::ivec3(first) + glm::ivec3(cell.Cell[0], cell.Cell[1], cell.Cell[2]);
          for (int axis = 0; axis < 3; ++axis)
          {
            hit->At.IndexPoint[axis] = hit->At.Cell[axis] + cell.Local[axis];
          }
          if ((nearest.WithoutGradient & GetBit(ray)) != 0)
          {
            this->Values.FindSmoothGradient(field, hit->At, nearest.Gradient[ray]);
          }
          hit->Normal = space.GetNormal(&nearest.Gradient[ray].x, rays[ray].Direction);
        });
      return nearest.Found;
    });
}

template <class Store>
RayMask LevelSurfaces<Store>::FindOccluded(const Sets& sets, const Ray* rays, RayMask wanted) const
{
  const IsovaluePredicate mayHold(sets.Isovalues);
  return ForEachPacket(sets.Field, mayHold, this->Kernel, nullptr, rays, wanted,
    [&](BeamBricks& bricks, LevelPackets& packets)
    {
      RayMask found = 0;
      bricks::DispatchSamples(sets.Field.Voxels->Lattice,
        [&](auto sample)
        {
          this->SearchBricks<decltype(sample)>(
            sets, bricks, packets, [&](const RayPacket&, RayMask meets) { return meets & ~found; },
            [&](const RayPacket& packet, RayMask some, std::size_t, const PacketBrick& surface,
              const BeamBricks::Brick& brick, const auto&, const auto&)
            { found |= this->Kernel.FindOccluded(packet, some & ~found, surface, brick.Lower); });
        });
      return found;
    });
}

template <class Store>
RayMask LevelSurfaces<Store>::Attenuate(const Sets& sets, const std::vector<glm::dvec3>& sheets,
  const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const
{
  const IsovaluePredicate mayHold(sets.Isovalues);
  return ForEachPacket(sets.Field, mayHold, this->Kernel, nullptr, rays, wanted,
    [&](BeamBricks& bricks, LevelPackets& packets)
    {
      // Counted first: products depend on the order of their factors, and the bricks have none.
      std::vector<int> counts(sets.Isovalues.size() * RayPacket::Size);
      bricks::DispatchSamples(sets.Field.Voxels->Lattice,
        [&](auto sample)
        {
          this->SearchBricks<decltype(sample)>(
            sets, bricks, packets, [](const RayPacket&, RayMask meets) { return meets; },
            [&](const RayPacket& packet, RayMask some, std::size_t isovalue,
              const PacketBrick& surface, const BeamBricks::Brick& brick, const auto&, const auto&)
            {
              this->Kernel.CountCrossings(
                packet, some, surface, brick.Lower, &counts[isovalue * RayPacket::Size]);
            });
        });
      return FindRays(packets.GetCoarsest().Rays,
        [&](int ray)
        {
          bool isDark = false;
          for (std::size_t isovalue = 0; isovalue < sheets.size(); ++isovalue)
          {
            const int count = counts[isovalue * RayPacket::Size + static_cast<std::size_t>(ray)];
            isDark = PassSheet(sheets[isovalue], count, transmittances[ray]);
          }
          return isDark;
        });
    });
}

} // namespace rt

#endif
