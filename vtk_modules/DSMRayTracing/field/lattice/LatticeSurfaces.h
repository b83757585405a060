// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticeSurfaces_h
#define rt_LatticeSurfaces_h

#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/lattice/IsosurfacePacketSearch.h"
#include "DSMRayTracing/field/lattice/IsosurfaceSearch.h"
#include "DSMRayTracing/object/ObjectTracer.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace rt
{

/// Finds the isosurfaces of a lattice for batches of rays. Rays within a beam, and those to a lamp, are searched as
/// packets, others one by one. Threads and pins as IsosurfaceSearch.
template <class Store>
class LatticeSurfaces
{
public:
  using Sets = LevelSets<LatticeField>;

  LatticeSurfaces(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Search(store, worker)
    , Packets(store, worker)
  {
  }

  /// See ObjectTracer.
  std::unique_ptr<ObjectBeam> FindBeam(const Sets& sets, const Ray corners[4]) const
  {
    return std::make_unique<BeamBricks>(this->Packets.FindBricks(sets, corners));
  }

  /// See ObjectTracer.
  bool Prefetch(const Sets& sets, const ObjectBeam& beam, std::size_t count) const
  {
    return PrefetchFirst(this->Blocks, *sets.Field.Voxels->Segment, beam, count,
      [&](dsm::BlockId id, std::vector<dsm::BlockId>& neighbors)
      { AddNeighbors(sets, id, neighbors); });
  }

  /// Finds the first hits of the `wanted` rays in [ray.Min, ray.Max], and returns the rays that have one. Calls
  /// `open(index, t)` for each of these, which returns where the IsosurfaceHit is to be stored, or null: nowhere.
  /// `beam`: from FindBeam, with all of the rays within; null: rays go where they like.
  template <class Open>
  RayMask Intersect(
    const Sets& sets, ObjectBeam* beam, const Ray* rays, RayMask wanted, const Open& open) const
  {
    return beam ? this->Packets.Intersect(sets, static_cast<BeamBricks&>(*beam), rays, wanted, open)
                : this->Search.IntersectEach(sets, rays, wanted, open);
  }

  RayMask FindOccluded(const Sets& sets, const Ray* rays, RayMask wanted) const
  {
    return this->Packets.FindOccluded(sets, rays, wanted);
  }

  /// `sheets`: what a surface lets through, for each isovalue. Returns the rays that are dark then.
  RayMask Attenuate(const Sets& sets, const std::vector<glm::dvec3>& sheets, const Ray* rays,
    RayMask wanted, glm::dvec3* transmittances) const
  {
    return this->Packets.Attenuate(sets, sheets, rays, wanted, transmittances);
  }

private:
  /// Bricks in a row are neighbors when they are in the same part of it, of so many.
  static constexpr std::int64_t PartOfRow = 8;

  /// Adds the neighbors of a brick in its row that may have part of the surface. In most files they
  /// are stored next to the brick, so a disk reads them along at low cost.
  static void AddNeighbors(const Sets& sets, dsm::BlockId id, std::vector<dsm::BlockId>& neighbors)
  {
    const bricks::VoxelField& field = *sets.Field.Voxels;
    const std::vector<bricks::ValueRange>& ranges = field.Hierarchy.GetLevels().front().Ranges;
    const IsovaluePredicate mayHold(sets.Isovalues);
    const bricks::Index3 place = field.Lattice.GetBrick(id);
    const std::int64_t first = place.x / PartOfRow * PartOfRow;
    const std::int64_t last = std::min(first + PartOfRow, field.Lattice.GetBricks().x) - 1;
    const auto find = [&](std::int64_t x) { return field.Lattice.GetId({ x, place.y, place.z }); };
    for (const std::int64_t step : { -1, 1 })
    {
      for (std::int64_t x = place.x + step; x >= first && x <= last && mayHold(ranges[find(x)]);
           x += step)
      {
        neighbors.push_back(find(x));
      }
    }
  }

  Store& Blocks;
  IsosurfaceSearch<Store> Search;
  IsosurfacePacketSearch<Store> Packets;
};

} // namespace rt

#endif
