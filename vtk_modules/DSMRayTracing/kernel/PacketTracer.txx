// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PacketTracer_txx
#define rt_PacketTracer_txx

#include "DSMRayTracing/brick/VoxelBrick.h"
#include "DSMRayTracing/kernel/HitGradient.h"
#include "DSMRayTracing/kernel/IndexSpace.h"
#include "DSMRayTracing/kernel/IsovalueLevel.h"
#include "DSMRayTracing/kernel/TypedPacketBrick.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>

namespace rt
{

template <class Store>
BeamBricks PacketTracer<Store>::FindBricks(
  const IsosurfaceObject& object, const Ray corners[4]) const
{
  const IndexSpace space(object.IndexToWorld, object.WorldToIndex);
  GridRay lines[4];
  for (int corner = 0; corner < 4; ++corner)
  {
    if (!space.GetGridRay(corners[corner], lines[corner]))
    {
      return BeamBricks();
    }
  }
  return BeamBricks(object.Field->Hierarchy, object.Isovalues, lines);
}

template <class Store>
void PacketTracer<Store>::Intersect(const IsosurfaceObject& object, const BeamBricks& bricks,
  int packets, const Ray* rays, const RayPacket::Mask* wanted, SurfaceHit* hits,
  RayPacket::Mask* found) const
{
  const IndexSpace space(object.IndexToWorld, object.WorldToIndex);
  const BrickLattice& lattice = object.Field->Lattice;
  Progress progress[MaxPackets];
  for (int number = 0; number < packets; ++number)
  {
    RayPacket& packet = progress[number].Rays;
    std::copy_n(bricks.Forward, 3, packet.Forward);
    const Ray* const own = rays + RayPacket::Size * number;
    RayPacket::Mask alone = wanted[number];
    if (bricks.Usable)
    {
      alone = this->Kernel.SetRays(packet, own, wanted[number], space, lattice.GetCells());
    }
    found[number] = 0;
    for (; alone != 0; alone &= alone - 1)
    {
      const int index = GetLowest(alone);
      const bool hit =
        this->Single.Intersect(object, own[index], hits[RayPacket::Size * number + index]);
      found[number] |= RayPacket::Mask{ hit } << index;
    }
  }
  Dispatch(lattice.GetScalarType(),
    [&](auto sample)
    { this->SearchBricks<decltype(sample)>(object, bricks, packets, progress, rays, hits); });
  for (int number = 0; number < packets; ++number)
  {
    found[number] |= progress[number].Found;
  }
}

template <class Store>
bool PacketTracer<Store>::MeetBrick(
  const BeamBricks::Brick& brick, int packets, Progress* progress) const
{
  bool isMet = false;
  for (int number = 0; number < packets; ++number)
  {
    Progress& packet = progress[number];
    const RayPacket::Mask open = packet.Rays.Rays & ~packet.Found;
    packet.Meets = open == 0 ? 0
                             : this->Kernel.MeetBox(packet.Rays, open, brick.Lower, brick.Upper,
                                 packet.Enter, packet.Leave);
    isMet = isMet || packet.Meets != 0;
  }
  return isMet;
}

template <class Store>
template <class T>
void PacketTracer<Store>::SearchBricks(const IsosurfaceObject& object, const BeamBricks& bricks,
  int packets, Progress* progress, const Ray* rays, SurfaceHit* hits) const
{
  const IndexSpace space(object.IndexToWorld, object.WorldToIndex);
  for (const BeamBricks::Brick& brick : bricks.Bricks)
  {
    if (!this->MeetBrick(brick, packets, progress))
    {
      continue;
    }
    const std::ptrdiff_t place = &brick - bricks.Bricks.data();
    bricks.Reached = std::max(bricks.Reached, static_cast<std::size_t>(place) + 1);
    this->SearchBrick<T>(object, brick, packets, progress);
    for (int number = 0; number < packets; ++number)
    {
      Progress& packet = progress[number];
      for (RayPacket::Mask left = packet.Hit; left != 0; left &= left - 1)
      {
        const int index = GetLowest(left);
        const CellHit cell = packet.Cells.Get(index);
        double* const gradient = &packet.Gradient[index].x;
        const int isovalue = packet.Isovalue[index];
        if ((packet.WithoutGradient >> index & 1) != 0)
        {
          HitGradient::Find<T>(this->Blocks, this->Self, *object.Field, brick.Id, cell,
            object.Isovalues[isovalue], gradient);
        }
        SurfaceHit& hit = hits[RayPacket::Size * number + index];
        hit.T = cell.T;
        hit.Normal = space.GetNormal(gradient, rays[RayPacket::Size * number + index].Direction);
        hit.Isovalue = isovalue;
        hit.FromInside = cell.FromInside;
        hit.Brick = brick.Id;
        for (int axis = 0; axis < 3; ++axis)
        {
          hit.IndexPoint[axis] = brick.Lower[axis] + cell.Cell[axis] + cell.Local[axis];
        }
      }
      packet.Found |= packet.Hit;
    }
  }
}

template <class Store>
template <class T>
void PacketTracer<Store>::SearchBrick(const IsosurfaceObject& object,
  const BeamBricks::Brick& brick, int packets, Progress* progress) const
{
  const typename Store::Pin pin =
    this->Blocks.Acquire(this->Self, *object.Field->Segment, brick.Id);
  const VoxelBrick<T> voxels(pin.GetData());
  const ValueRange range{ voxels.GetHeader().First, voxels.GetHeader().Last };
  for (int number = 0; number < packets; ++number)
  {
    progress[number].Hit = 0;
    progress[number].WithoutGradient = 0;
  }
  for (std::size_t isovalue = 0; isovalue < object.Isovalues.size(); ++isovalue)
  {
    if (!range.MayHold(object.Isovalues[isovalue]))
    {
      continue;
    }
    const IsovalueLevel<T> level(object.Isovalues[isovalue]);
    TypedPacketBrick<T> surface(voxels, level, this->Kernel.Macrocells.Get<T>());
    for (int number = 0; number < packets; ++number)
    {
      Progress& packet = progress[number];
      PacketHits candidates;
      RayPacket::Mask met = packet.Meets == 0
        ? 0
        : this->Kernel.SearchBrick(packet.Rays, packet.Meets, surface, brick.Lower, packet.Enter,
            packet.Leave, candidates);
      for (; met != 0; met &= met - 1)
      {
        const int index = GetLowest(met);
        const RayPacket::Mask bit = RayPacket::Mask{ 1 } << index;
        if ((packet.Hit & bit) != 0 && !(candidates.T[index] < packet.Cells.T[index]))
        {
          continue;
        }
        packet.Cells.Set(index, candidates);
        packet.Isovalue[index] = static_cast<int>(isovalue);
        packet.Hit |= bit;
        const bool within =
          HitGradient::FindWithin(voxels, candidates.Get(index), level, &packet.Gradient[index].x);
        packet.WithoutGradient =
          within ? packet.WithoutGradient & ~bit : packet.WithoutGradient | bit;
      }
    }
  }
}

template <class Store>
std::uint64_t PacketTracer<Store>::FindOccluded(
  const IsosurfaceObject& object, const Ray* rays, std::uint64_t wanted) const
{
  const IndexSpace space(object.IndexToWorld, object.WorldToIndex);
  std::uint64_t sides[8] = {};
  glm::dvec3 sums[8] = {};
  for (std::uint64_t left = wanted; left != 0; left &= left - 1)
  {
    const int index = __builtin_ctzll(left);
    const glm::dvec3 direction = space.GetWorldToIndex() * rays[index].Direction;
    const int side = (direction.x > 0.0) | (direction.y > 0.0) << 1 | (direction.z > 0.0) << 2;
    sides[side] |= left & (~left + 1);
    sums[side] += direction / glm::length(direction);
  }
  std::uint64_t occluded = 0;
  for (int side = 0; side < 8; ++side)
  {
    const int count = __builtin_popcountll(sides[side]);
    if (count < FewestInBeam || !(glm::length(sums[side]) > BeamCoherence * count))
    {
      for (std::uint64_t left = sides[side]; left != 0; left &= left - 1)
      {
        const int index = __builtin_ctzll(left);
        occluded |= std::uint64_t{ this->Single.IsOccluded(object, rays[index]) } << index;
      }
      continue;
    }
    Group group;
    for (int axis = 0; axis < 3; ++axis)
    {
      group.Forward[axis] = (side >> axis & 1) != 0;
    }
    for (std::uint64_t left = sides[side]; left != 0; left &= left - 1)
    {
      group.Rays[group.Count++] = rays[__builtin_ctzll(left)];
    }
    std::uint64_t met = this->FindOccludedInGroup(object, group);
    for (std::uint64_t left = sides[side]; left != 0; left &= left - 1, met >>= 1)
    {
      occluded |= (met & 1) != 0 ? left & (~left + 1) : 0;
    }
  }
  return occluded;
}

template <class Store>
std::uint64_t PacketTracer<Store>::FindOccludedInGroup(
  const IsosurfaceObject& object, const Group& group) const
{
  const IndexSpace space(object.IndexToWorld, object.WorldToIndex);
  const BrickLattice& lattice = object.Field->Lattice;
  Progress progress[MaxPackets];
  const RayPacket* crossing[MaxPackets];
  int packets = 0;
  int crossingCount = 0;
  for (int first = 0; first < group.Count; first += RayPacket::Size, ++packets)
  {
    Progress& packet = progress[packets];
    std::copy_n(group.Forward, 3, packet.Rays.Forward);
    const Ray* const own = group.Rays + first;
    const int count = std::min(RayPacket::Size, group.Count - first);
    RayPacket::Mask alone = this->Kernel.SetRays(
      packet.Rays, own, (RayPacket::Mask{ 1 } << count) - 1, space, lattice.GetCells());
    for (; alone != 0; alone &= alone - 1)
    {
      const int index = GetLowest(alone);
      packet.Found |= RayPacket::Mask{ this->Single.IsOccluded(object, own[index]) } << index;
    }
    if (packet.Rays.Rays != 0)
    {
      crossing[crossingCount++] = &packet.Rays;
    }
  }
  if (crossingCount > 0)
  {
    RayBeam beam;
    beam.Set(crossing, crossingCount);
    const BeamBricks bricks(object.Field->Hierarchy, object.Isovalues, beam);
    Dispatch(lattice.GetScalarType(),
      [&](auto sample)
      {
        for (const BeamBricks::Brick& brick : bricks.Bricks)
        {
          if (this->MeetBrick(brick, packets, progress))
          {
            this->FindOccludedInBrick<decltype(sample)>(object, brick, packets, progress);
          }
        }
      });
  }
  std::uint64_t occluded = 0;
  for (int number = 0; number < packets; ++number)
  {
    occluded |= std::uint64_t{ progress[number].Found } << (RayPacket::Size * number);
  }
  return occluded;
}

template <class Store>
template <class T>
void PacketTracer<Store>::FindOccludedInBrick(const IsosurfaceObject& object,
  const BeamBricks::Brick& brick, int packets, Progress* progress) const
{
  const typename Store::Pin pin =
    this->Blocks.Acquire(this->Self, *object.Field->Segment, brick.Id);
  const VoxelBrick<T> voxels(pin.GetData());
  const ValueRange range{ voxels.GetHeader().First, voxels.GetHeader().Last };
  for (const double isovalue : object.Isovalues)
  {
    if (!range.MayHold(isovalue))
    {
      continue;
    }
    const IsovalueLevel<T> level(isovalue);
    const TypedPacketBrick<T> surface(voxels, level, this->Kernel.Macrocells.Get<T>());
    for (int number = 0; number < packets; ++number)
    {
      Progress& packet = progress[number];
      const RayPacket::Mask open = packet.Meets & ~packet.Found;
      if (open != 0)
      {
        packet.Found |= this->Kernel.FindOccluded(
          packet.Rays, open, surface, brick.Lower, packet.Enter, packet.Leave);
      }
    }
  }
}

} // namespace rt

#endif
