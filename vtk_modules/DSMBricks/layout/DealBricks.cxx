// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/DealBricks.h"

#include <glm/common.hpp>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace bricks
{

namespace
{

/// Bricks, or chunks where these are larger, along an edge of the largest box. Chunks at its faces are read by
/// several owners, since bricks have the first samples of their neighbors, too.
constexpr std::int64_t LargestBox = 8;
/// So many boxes for each rank balance what the ranks read.
constexpr std::int64_t BoxesOfRank = 32;
/// And so many must be, even if chunks are then read by several ranks.
constexpr std::int64_t LeastBoxesOfRank = 4;

/// Boxes of as many samples along each axis.
struct Boxes
{
  const BrickLattice& Lattice;
  Index3 First;
  Index3 Widths;

  /// Returns a number for each brick, by its position along an axis.
  std::vector<std::uint32_t> Number(int axis) const
  {
    std::vector<std::uint32_t> numbers;
    std::uint32_t number = 0;
    std::int64_t last = this->First[axis] / this->Widths[axis];
    for (std::int64_t brick = 0; brick < this->Lattice.GetBricks()[axis]; ++brick)
    {
      const std::int64_t box =
        (this->First[axis] + brick * this->Lattice.GetEdge()) / this->Widths[axis];
      number += box != last ? 1 : 0;
      last = box;
      numbers.push_back(number);
    }
    return numbers;
  }

  std::int64_t GetCount() const
  {
    std::int64_t count = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
      count *= static_cast<std::int64_t>(this->Number(axis).back()) + 1;
    }
    return count;
  }

  /// Halves them where they are widest until there are so many, but keeps to multiples of the units.
  void Halve(const Index3& units, std::int64_t wanted)
  {
    while (this->GetCount() < wanted)
    {
      int widest = -1;
      for (int axis = 0; axis < 3; ++axis)
      {
        if (this->Widths[axis] > units[axis] &&
          (widest < 0 || this->Widths[axis] > this->Widths[widest]))
        {
          widest = axis;
        }
      }
      if (widest < 0)
      {
        return;
      }
      const std::int64_t unit = units[widest];
      this->Widths[widest] = (this->Widths[widest] / unit + 1) / 2 * unit;
    }
  }
};

} // namespace

dsm::BlockAssigner DealBricks(
  const BrickLattice& lattice, const Index3& chunk, const Index3& first, int ranks)
{
  const Index3 edge(lattice.GetEdge());
  const Index3 units = glm::max(chunk, edge);
  Boxes boxes{ lattice, first, LargestBox * units };
  boxes.Halve(units, BoxesOfRank * ranks);
  boxes.Halve(edge, LeastBoxesOfRank * ranks);
  return dsm::BlockAssigner({ boxes.Number(0), boxes.Number(1), boxes.Number(2) }, ranks);
}

} // namespace bricks
