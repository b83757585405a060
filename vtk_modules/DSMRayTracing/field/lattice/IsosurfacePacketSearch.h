// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfacePacketSearch_h
#define rt_IsosurfacePacketSearch_h

#include "DSMRayTracing/field/LevelSets.h"
#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/IsosurfaceSearch.h"
#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"
#include "DSMRayTracing/field/lattice/RayBeam.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace rt
{

/// Finds isosurface hits for rays of a beam: the bricks that lie in it are acquired one after the
/// other, front to back, and each is searched for all of the packet's rays that meet it. A ray finds,
/// bit for bit, what IsosurfaceSearch finds for it, whatever packets, mates and vectors it has; rays that
/// do not fit the others are left to IsosurfaceSearch.
///
/// Threads and pins as IsosurfaceSearch.
template <class Store>
class IsosurfacePacketSearch
{
public:
  using Sets = LevelSets<LatticeField>;
  using Hit = LatticeHit;

  IsosurfacePacketSearch(Store& store, typename Store::Worker& worker,
    const PacketKernel& kernel = PacketKernel::GetBest())
    : Blocks(store)
    , Self(worker)
    , Single(store, worker)
    , Kernel(kernel)
  {
  }

  /// The bricks that rays between those of `corners`, in order around them, may find hits in.
  static BeamBricks FindBricks(const Sets& sets, const Ray corners[4]);

  /// IsosurfaceSearch::Intersect for those of RayPacket::Size rays that are `wanted`. All of them lie
  /// within the beam that `bricks` was found for. Returns those that hit something, and calls
  /// `open(index, t)` for each of them, which says where the hit is to be stored, or null: nowhere.
  template <class Open>
  RayMask Intersect(
    const Sets& sets, BeamBricks& bricks, const Ray* rays, RayMask wanted, const Open& open) const;

  /// IsosurfaceSearch::IsOccluded for those of RayPacket::Size rays that are `wanted`. They need not have
  /// anything in common, but are traced together where they go the same way.
  RayMask FindOccluded(const Sets& sets, const Ray* rays, RayMask wanted) const;

  /// IsosurfaceSearch::Attenuate for the same; returns those that are dark then.
  RayMask Attenuate(const Sets& sets, const std::vector<glm::dvec3>& sheets, const Ray* rays,
    RayMask wanted, glm::dvec3* transmittances) const;

private:
  /// A packet on its way through the bricks.
  struct Progress
  {
    RayPacket Rays;
    RayMask Found = 0;
    // In the current brick:
    RayMask Meets = 0;
    RayMask Hit = 0;
    RayMask WithoutGradient = 0;
    CellHit Cells[RayPacket::Size];
    int Isovalue[RayPacket::Size];
    glm::dvec3 Gradient[RayPacket::Size];
  };

  static BeamBricks FindBricks(const Sets& sets, const RayBeam& beam);

  /// Finds out which rays that have not found anything yet cross a brick, and where; returns whether
  /// any does.
  bool MeetBrick(const BeamBricks::Brick& brick, Progress& progress) const;

  template <class T, class Open>
  void SearchBricks(const Sets& sets, BeamBricks& bricks, Progress& progress, const Ray* rays,
    const Open& open) const;

  /// Acquires the brick and searches it for all rays that meet it.
  template <class T>
  void SearchBrick(const Sets& sets, const BeamBricks::Brick& brick, Progress& progress) const;

  /// Fewer rays are as fast one by one.
  static constexpr int FewestInBeam = 8;
  /// Length of the mean of unit directions: those of less have too little in common for a beam.
  static constexpr double BeamCoherence = 0.98;

  /// Searches those of RayPacket::Size rays that are `wanted`, together where they go the same way, and returns those
  /// whose search ended early. Ask each brick's surfaces in turn:
  ///
  ///   bool alone(int ray): searches all of a ray
  ///   RayMask together(packet, open, index, surface, origin): searches a PacketBrick, whose first cell is at `origin`,
  ///     for the isovalue of that index and the rays that are still `open`
  ///
  /// Both return the rays whose search ends.
  template <class SearchAlone, class SearchSurface>
  RayMask SearchForLight(const Sets& sets, const Ray* rays, RayMask wanted,
    const SearchAlone& alone, const SearchSurface& together) const;

  /// The same for rays that all move to the same sides.
  template <class SearchAlone, class SearchSurface>
  RayMask SearchPacketForLight(const Sets& sets, const bool forward[3], const Ray* rays,
    RayMask wanted, const SearchAlone& alone, const SearchSurface& together) const;

  /// The same in a brick: adds those whose search ends to what is found.
  template <class T, class SearchSurface>
  void SearchBrickForLight(const Sets& sets, const BeamBricks::Brick& brick, Progress& progress,
    const SearchSurface& together) const;

  Store& Blocks;
  typename Store::Worker& Self;
  IsosurfaceSearch<Store> Single;
  const PacketKernel& Kernel;
};

} // namespace rt

#include "DSMRayTracing/field/lattice/IsosurfacePacketSearch.txx"

#endif
