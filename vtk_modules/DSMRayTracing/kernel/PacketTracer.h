// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PacketTracer_h
#define rt_PacketTracer_h

#include "DSMRayTracing/frame/Scene.h"
#include "DSMRayTracing/kernel/BeamBricks.h"
#include "DSMRayTracing/kernel/PacketKernel.h"
#include "DSMRayTracing/kernel/Ray.h"
#include "DSMRayTracing/kernel/VolumeTracer.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace rt
{

/// Finds isosurface hits for the rays of a tile: the bricks that lie in the tile's beam are acquired
/// one after the other, front to back, and each is searched by all packets of the tile. A ray finds,
/// bit for bit, what VolumeTracer finds for it, whatever packets, mates and vectors it has; rays that
/// do not fit the others are left to VolumeTracer.
///
/// Threads and pins as VolumeTracer.
template <class Store>
class PacketTracer
{
public:
  /// At once.
  static constexpr int MaxPackets = 4;

  PacketTracer(Store& store, typename Store::Worker& worker,
    const PacketKernel& kernel = PacketKernel::GetBest())
    : Blocks(store)
    , Self(worker)
    , Single(store, worker)
    , Kernel(kernel)
  {
  }

  /// The bricks that rays between those of `corners`, in order around them, may find hits in.
  BeamBricks FindBricks(const IsosurfaceObject& object, const Ray corners[4]) const;

  /// Asks for bricks ahead of Intersect; returns whether any was absent. Never waits.
  bool Prefetch(const IsosurfaceObject& object, const std::vector<dsm::BlockId>& bricks) const
  {
    return this->Blocks.Prefetch(*object.Field->Segment, bricks.data(), bricks.size());
  }

  /// VolumeTracer::Intersect for the rays of `wanted` in each packet of RayPacket::Size rays. All of
  /// them lie within the beam that `bricks` was found for. `found` tells those that hit something.
  void Intersect(const IsosurfaceObject& object, const BeamBricks& bricks, int packets,
    const Ray* rays, const RayPacket::Mask* wanted, SurfaceHit* hits, RayPacket::Mask* found) const;

  /// VolumeTracer::IsOccluded for those of up to 64 rays (bits) that are `wanted`. They need not
  /// have anything in common, but are traced together where they go the same way.
  std::uint64_t FindOccluded(
    const IsosurfaceObject& object, const Ray* rays, std::uint64_t wanted) const;

private:
  /// A packet on its way through the bricks.
  struct Progress
  {
    RayPacket Rays;
    RayPacket::Mask Found = 0;
    // In the current brick:
    RayPacket::Mask Meets = 0;
    alignas(64) double Enter[RayPacket::Size];
    alignas(64) double Leave[RayPacket::Size];
    RayPacket::Mask Hit = 0;
    RayPacket::Mask WithoutGradient = 0;
    PacketHits Cells;
    int Isovalue[RayPacket::Size];
    glm::dvec3 Gradient[RayPacket::Size];
  };

  /// Where the rays of packets that have not found anything yet cross a brick; returns whether any
  /// does.
  bool MeetBrick(const BeamBricks::Brick& brick, int packets, Progress* progress) const;

  template <class T>
  void SearchBricks(const IsosurfaceObject& object, const BeamBricks& bricks, int packets,
    Progress* progress, const Ray* rays, SurfaceHit* hits) const;

  /// Acquires the brick and searches it for all packets that meet it.
  template <class T>
  void SearchBrick(const IsosurfaceObject& object, const BeamBricks::Brick& brick, int packets,
    Progress* progress) const;

  /// Fewer rays are as fast one by one.
  static constexpr int FewestInBeam = 8;
  /// Length of the mean of unit directions: those of less have too little in common for a beam.
  static constexpr double BeamCoherence = 0.98;

  /// Rays that all move to the same sides, in order and without gaps.
  struct Group
  {
    Ray Rays[MaxPackets * RayPacket::Size];
    int Count = 0;
    bool Forward[3];
  };

  /// FindOccluded for a group; bit i is its ray i.
  std::uint64_t FindOccludedInGroup(const IsosurfaceObject& object, const Group& group) const;

  /// Adds those of `packets` that meet a surface in a brick to what they have found.
  template <class T>
  void FindOccludedInBrick(const IsosurfaceObject& object, const BeamBricks::Brick& brick,
    int packets, Progress* progress) const;

  Store& Blocks;
  typename Store::Worker& Self;
  VolumeTracer<Store> Single;
  const PacketKernel& Kernel;
};

} // namespace rt

#include "DSMRayTracing/kernel/PacketTracer.txx"

#endif
