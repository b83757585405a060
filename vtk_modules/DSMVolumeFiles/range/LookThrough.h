// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_LookThrough_h
#define vol_LookThrough_h

#include "DSMBricks/build/BrickLooker.h"
#include "DSMVolumeFiles/range/ValueRanges.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace vol
{

/// Bricks in the order in which the chunks that they lie in are best read through the shared cache. `bricks`: which, on
/// the lattice of bricks; `first`: the sample of the array at the lattice's first point.
std::vector<dsm::BlockId> OrderBricks(const bricks::BrickLattice& lattice,
  const bricks::Box& bricks, const FileArray& array, const bricks::Index3& first);

/// Whether the bricks that an array is drawn with can be looked at in the same reading as its ranges are found: they
/// have samples in common with their neighbours, so the shared cache has to hold the chunks of many.
bool CanLookAtBricks(const FileArray& array);

/// What all of a box of an array was read for.
struct Look
{
  ValueRanges Ranges; ///< of the samples of the box
  /// The bricks, of all of the array, of which the first cell is among the box's cells.
  bricks::SeenBricks Bricks;
};

/// As FindRanges, of an array that CanLookAtBricks; local.
std::optional<Look> LookThrough(const std::shared_ptr<const VolumeFile>& file, std::size_t array,
  int step, const bricks::Box& box, int threads, const std::function<bool(double)>& goesOn);

} // namespace vol

#endif
