// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CornerRoutes_h
#define bricks_CornerRoutes_h

#include "DSMCore/base/Block.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bricks
{

/// Where the points of this rank's cells are in the bricks of cells of all ranks: by these, new values go to the
/// bricks, and nothing else moves. A point is in several bricks where its cells are.
struct CornerRoutes
{
  /// Corners of one brick that this rank's points are.
  struct Brick
  {
    dsm::BlockId Id;
    std::size_t Begin; ///< of its entries in Slots and Points; those of the next brick follow
  };

  std::vector<Brick> Bricks;
  std::vector<std::uint16_t> Slots;  ///< number of the corner in the brick
  std::vector<std::uint32_t> Points; ///< number of the point in the source
};

} // namespace bricks

#endif
