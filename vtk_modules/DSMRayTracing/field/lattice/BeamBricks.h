// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BeamBricks_h
#define rt_BeamBricks_h

#include "DSMCore/base/Block.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMRayTracing/object/ObjectBeam.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace rt
{

/// The bricks that may hold what rays look for, and that rays of a beam may meet: what the rays of a tile
/// have in common, so that each need not walk the levels above the bricks. The order is front to
/// back for every ray of the beam. Made by BeamDescent.
struct BeamBricks final : ObjectBeam
{
  struct Brick
  {
    dsm::BlockId Id;
    double Lower[3]; ///< its first cell
    double Upper[3]; ///< the planes at its end; the volume's end may come before
  };

  /// True for each axis along which all rays move towards larger coordinates.
  bool Forward[3] = { false, false, false };
  std::vector<Brick> Bricks; ///< empty and without meaning if the beam is not usable

  bool MayMeet() const override { return !this->Usable || !this->Bricks.empty(); }

  /// Ids of the first bricks, at most so many.
  std::vector<dsm::BlockId> GetFirst(std::size_t count) const
  {
    std::vector<dsm::BlockId> ids;
    for (std::size_t place = 0; place < std::min(count, this->Bricks.size()); ++place)
    {
      ids.push_back(this->Bricks[place].Id);
    }
    return ids;
  }
};

/// BeamFinder::Prefetch of a beam's bricks, which are a segment's. `addNeighbors`: see the store's Prefetch; may be
/// empty.
template <class Store>
bool PrefetchFirst(Store& store, const dsm::BlockSegment& segment, const ObjectBeam& beam,
  std::size_t count,
  dsm::FunctionRef<void(dsm::BlockId, std::vector<dsm::BlockId>&)> addNeighbors = {})
{
  const std::vector<dsm::BlockId> ids = static_cast<const BeamBricks&>(beam).GetFirst(count);
  return store.Prefetch(segment, ids.data(), ids.size(), addNeighbors);
}

} // namespace rt

#endif
