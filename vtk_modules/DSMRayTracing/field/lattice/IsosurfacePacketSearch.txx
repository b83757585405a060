// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfacePacketSearch_txx
#define rt_IsosurfacePacketSearch_txx

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/grid/HitGradient.h"
#include "DSMRayTracing/field/grid/IndexSpace.h"
#include "DSMRayTracing/field/grid/IsovalueLevel.h"
#include "DSMRayTracing/field/lattice/BeamDescent.h"
#include "DSMRayTracing/field/lattice/IsovalueTest.h"
#include "DSMRayTracing/field/lattice/TypedPacketBrick.h"
#include "DSMRayTracing/look/SheetTransmittance.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>

namespace rt
{

template <class Store>
BeamBricks IsosurfacePacketSearch<Store>::FindBricks(const Sets& sets, const Ray corners[4])
{
  const IsovaluePredicate mayHold(sets.Isovalues);
  return FindBeamBricks(sets.Field, mayHold, corners);
}

template <class Store>
BeamBricks IsosurfacePacketSearch<Store>::FindBricks(const Sets& sets, const RayBeam& beam)
{
  const IsovaluePredicate mayHold(sets.Isovalues);
  const bricks::VoxelField& field = *sets.Field.Voxels;
  return BeamDescent<IsovaluePredicate>(field.Hierarchy, mayHold, beam, field.Planes.get()).Find();
}

template <class Store>
template <class Open>
RayMask IsosurfacePacketSearch<Store>::Intersect(
  const Sets& sets, BeamBricks& bricks, const Ray* rays, RayMask wanted, const Open& open) const
{
  const IndexSpace space = sets.Field.GetIndexSpace();
  const bricks::BrickLattice& lattice = sets.Field.Voxels->Lattice;
  Progress progress;
  std::copy_n(bricks.Forward, 3, progress.Rays.Forward);
  RayMask alone = wanted;
  if (bricks.Usable)
  {
    alone = this->Kernel.SetRays(progress.Rays, rays, wanted, space, lattice.GetCells());
  }
  const RayMask found = this->Single.IntersectEach(sets, rays, alone, open);
  bricks::Dispatch(lattice.GetScalarType(),
    [&](auto sample) { this->SearchBricks<decltype(sample)>(sets, bricks, progress, rays, open); });
  return found | progress.Found;
}

template <class Store>
bool IsosurfacePacketSearch<Store>::MeetBrick(
  const BeamBricks::Brick& brick, Progress& progress) const
{
  const RayMask open = progress.Rays.Rays & ~progress.Found;
  progress.Meets =
    open == 0 ? 0 : this->Kernel.MeetBrick(progress.Rays, open, brick.Lower, brick.Upper);
  return progress.Meets != 0;
}

template <class Store>
template <class T, class Open>
void IsosurfacePacketSearch<Store>::SearchBricks(
  const Sets& sets, BeamBricks& bricks, Progress& progress, const Ray* rays, const Open& open) const
{
  const IndexSpace space = sets.Field.GetIndexSpace();
  for (const BeamBricks::Brick& brick : bricks.Bricks)
  {
    if (!this->MeetBrick(brick, progress))
    {
      continue;
    }
    const std::ptrdiff_t place = &brick - bricks.Bricks.data();
    bricks.Reached = std::max(bricks.Reached, static_cast<std::size_t>(place) + 1);
    this->SearchBrick<T>(sets, brick, progress);
    ForEachRay(progress.Hit,
      [&](int index)
      {
        const CellHit& cell = progress.Cells[index];
        double* const gradient = &progress.Gradient[index].x;
        const int isovalue = progress.Isovalue[index];
        if ((progress.WithoutGradient >> index & 1) != 0)
        {
          HitGradient::Find<T>(this->Blocks, this->Self, *sets.Field.Voxels, brick.Id, cell,
            sets.Isovalues[isovalue], gradient);
        }
        Hit* const hit = open(index, cell.T);
        if (!hit)
        {
          return;
        }
        hit->T = cell.T;
        hit->Normal = space.GetNormal(gradient, rays[index].Direction);
        hit->Isovalue = isovalue;
        hit->FromInside = cell.FromInside;
        hit->At.Brick = brick.Id;
        for (int axis = 0; axis < 3; ++axis)
        {
          hit->At.IndexPoint[axis] = brick.Lower[axis] + cell.Cell[axis] + cell.Local[axis];
          hit->At.Cell[axis] = static_cast<int>(brick.Lower[axis]) + cell.Cell[axis];
        }
      });
    progress.Found |= progress.Hit;
  }
}

template <class Store>
template <class T>
void IsosurfacePacketSearch<Store>::SearchBrick(
  const Sets& sets, const BeamBricks::Brick& brick, Progress& progress) const
{
  const typename Store::Pin pin =
    this->Blocks.Acquire(this->Self, *sets.Field.Voxels->Segment, brick.Id);
  const bricks::VoxelBrick<T> voxels(pin.GetData());
  const bricks::ValueRange range{ voxels.GetHeader().First, voxels.GetHeader().Last };
  progress.Hit = 0;
  progress.WithoutGradient = 0;
  for (std::size_t isovalue = 0; isovalue < sets.Isovalues.size(); ++isovalue)
  {
    if (!range.MayHold(sets.Isovalues[isovalue]))
    {
      continue;
    }
    const IsovalueLevel<T> level(sets.Isovalues[isovalue]);
    const IsovalueTest<T> test(level, this->Kernel.Macrocells.template Get<T>());
    const TypedPacketBrick<T, IsovalueTest<T>> surface(voxels, test, progress.Rays.Forward);
    PacketHits candidates;
    this->Kernel.SearchBrick(progress.Rays, progress.Meets, surface, brick.Lower, candidates);
    for (int number = 0; number < candidates.Count; ++number)
    {
      const int index = candidates.Ray[number];
      const RayMask bit = GetBit(index);
      CellHit& cell = progress.Cells[index];
      if ((progress.Hit & bit) != 0 && !(candidates.T[number] < cell.T))
      {
        continue;
      }
      cell = candidates.Get(number);
      progress.Isovalue[index] = static_cast<int>(isovalue);
      progress.Hit |= bit;
      const bool within = HitGradient::FindWithin(
        *sets.Field.Voxels, brick.Id, voxels, cell, level, &progress.Gradient[index].x);
      progress.WithoutGradient =
        within ? progress.WithoutGradient & ~bit : progress.WithoutGradient | bit;
    }
  }
}

template <class Store>
RayMask IsosurfacePacketSearch<Store>::FindOccluded(
  const Sets& sets, const Ray* rays, RayMask wanted) const
{
  return this->SearchForLight(
    sets, rays, wanted, [&](int ray) { return this->Single.IsOccluded(sets, rays[ray]); },
    [&](const RayPacket& packet, RayMask open, std::size_t, const PacketBrick& surface,
      const double origin[3]) { return this->Kernel.FindOccluded(packet, open, surface, origin); });
}

template <class Store>
RayMask IsosurfacePacketSearch<Store>::Attenuate(const Sets& sets,
  const std::vector<glm::dvec3>& sheets, const Ray* rays, RayMask wanted,
  glm::dvec3* transmittances) const
{
  return this->SearchForLight(
    sets, rays, wanted,
    [&](int ray) { return this->Single.Attenuate(sets, sheets, rays[ray], transmittances[ray]); },
    [&](const RayPacket& packet, RayMask open, std::size_t isovalue, const PacketBrick& surface,
      const double origin[3])
    {
      int counts[RayPacket::Size] = {};
      this->Kernel.CountCrossings(packet, open, surface, origin, counts);
      return FindRays(open,
        [&](int ray) { return PassSheet(sheets[isovalue], counts[ray], transmittances[ray]); });
    });
}

template <class Store>
template <class SearchAlone, class SearchSurface>
RayMask IsosurfacePacketSearch<Store>::SearchForLight(const Sets& sets, const Ray* rays,
  RayMask wanted, const SearchAlone& alone, const SearchSurface& together) const
{
  if (GetCount(wanted) < FewestInBeam)
  {
    return FindRays(wanted, alone);
  }
  const IndexSpace space = sets.Field.GetIndexSpace();
  RayMask sides[8] = {};
  glm::dvec3 sums[8] = {};
  ForEachRay(wanted,
    [&](int index)
    {
      const glm::dvec3 direction = space.GetWorldToIndex() * rays[index].Direction;
      const int side = (direction.x > 0.0) | (direction.y > 0.0) << 1 | (direction.z > 0.0) << 2;
      sides[side] |= GetBit(index);
      sums[side] += direction / glm::length(direction);
    });
  RayMask ended = 0;
  for (int side = 0; side < 8; ++side)
  {
    const int count = GetCount(sides[side]);
    const bool forward[3] = { (side & 1) != 0, (side & 2) != 0, (side & 4) != 0 };
    ended |= count >= FewestInBeam && glm::length(sums[side]) > BeamCoherence * count
      ? this->SearchPacketForLight(sets, forward, rays, sides[side], alone, together)
      : FindRays(sides[side], alone);
  }
  return ended;
}

template <class Store>
template <class SearchAlone, class SearchSurface>
RayMask IsosurfacePacketSearch<Store>::SearchPacketForLight(const Sets& sets, const bool forward[3],
  const Ray* rays, RayMask wanted, const SearchAlone& alone, const SearchSurface& together) const
{
  const IndexSpace space = sets.Field.GetIndexSpace();
  const bricks::BrickLattice& lattice = sets.Field.Voxels->Lattice;
  Progress progress;
  std::copy_n(forward, 3, progress.Rays.Forward);
  progress.Found =
    FindRays(this->Kernel.SetRays(progress.Rays, rays, wanted, space, lattice.GetCells()), alone);
  if (progress.Rays.Rays != 0)
  {
    RayBeam beam;
    beam.Set(progress.Rays);
    const BeamBricks bricks = FindBricks(sets, beam);
    bricks::Dispatch(lattice.GetScalarType(),
      [&](auto sample)
      {
        for (const BeamBricks::Brick& brick : bricks.Bricks)
        {
          if (this->MeetBrick(brick, progress))
          {
            this->SearchBrickForLight<decltype(sample)>(sets, brick, progress, together);
          }
        }
      });
  }
  return progress.Found;
}

template <class Store>
template <class T, class SearchSurface>
void IsosurfacePacketSearch<Store>::SearchBrickForLight(const Sets& sets,
  const BeamBricks::Brick& brick, Progress& progress, const SearchSurface& together) const
{
  const typename Store::Pin pin =
    this->Blocks.Acquire(this->Self, *sets.Field.Voxels->Segment, brick.Id);
  const bricks::VoxelBrick<T> voxels(pin.GetData());
  const bricks::ValueRange range{ voxels.GetHeader().First, voxels.GetHeader().Last };
  for (std::size_t index = 0; index < sets.Isovalues.size(); ++index)
  {
    const double isovalue = sets.Isovalues[index];
    const RayMask open = progress.Meets & ~progress.Found;
    if (open == 0 || !range.MayHold(isovalue))
    {
      continue;
    }
    const IsovalueLevel<T> level(isovalue);
    const IsovalueTest<T> test(level, this->Kernel.Macrocells.template Get<T>());
    const TypedPacketBrick<T, IsovalueTest<T>> surface(voxels, test, progress.Rays.Forward);
    progress.Found |= together(progress.Rays, open, index, surface, brick.Lower);
  }
}

} // namespace rt

#endif
