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

/// Returns whether the bricks that an array is drawn with can be examined in the same pass that finds its ranges.
/// Bricks share samples with their neighbors, so the shared cache has to hold the chunks of many bricks.
bool CanLookAtBricks(const FileArray& array);

/// Results of one pass over a box of an array.
struct Look
{
  ValueRanges Ranges; ///< ranges of the samples in the box
  /// The bricks, of all of the array, of which the first cell is among the box's cells.
  bricks::SeenBricks Bricks;
};

/// As FindRanges, of an array that CanLookAtBricks; local.
std::optional<Look> LookThrough(const ArrayStep& of, const bricks::Box& box, int threads,
  const std::function<bool(double)>& goesOn);

} // namespace vol

#endif
