// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PointPlaces_h
#define bricks_PointPlaces_h

#include "DSMBricks/cells/CellSource.h"
#include "DSMBricks/layout/BrickSpace.h"
#include "DSMCore/memory/BlockArena.h"

#include <cmath>
#include <cstdint>

namespace bricks
{

/// The places of a source's points in the space of the bricks (PlaceInBrick), found once for all cells that share
/// them. Takes 12 bytes a point.
class PointPlaces
{
public:
  PointPlaces() = default;
  /// `threads`: the calling one included. Throws std::bad_alloc.
  PointPlaces(const CellSource& source, const BrickSpace& space, int threads);

  /// Three coordinates. Any thread.
  const float* Get(std::uint64_t point) const { return this->Places + 3 * point; }
  /// Returns whether the coordinates of a place are finite.
  static bool IsFinite(const float* place) { return !std::isnan(place[0]); }

private:
  dsm::BlockArena Memory; ///< in large pages, since points are met in any order
  float* Places = nullptr;
};

} // namespace bricks

#endif
