// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockAssigner_h
#define dsm_BlockAssigner_h

#include "DSMCore/base/Block.h"

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace dsm
{

/// Which rank each block of a segment belongs to: they are dealt one by one, round robin, or, where they lie on
/// a grid and neighbors had better belong to the same rank, in boxes of blocks. Either way no rank gets more
/// than one block, or box, more than another. Cheap to copy.
class BlockAssigner
{
public:
  BlockAssigner(RoundRobinAssigner oneByOne)
    : OneByOne(oneByOne)
  {
  }
  /// Blocks of a grid, numbered x fastest. `boxes`: for each axis the box that a block is in, by its place along
  /// the axis: ascending from 0, without gaps.
  BlockAssigner(std::array<std::vector<std::uint32_t>, 3> boxes, int ranks)
    : OneByOne(ranks)
    , Ranks(static_cast<BlockId>(ranks))
    , Boxes(std::make_shared<const std::array<std::vector<std::uint32_t>, 3>>(std::move(boxes)))
  {
  }

  int GetOwner(BlockId id) const
  {
    if (!this->Boxes)
    {
      return this->OneByOne.GetOwner(id);
    }
    const auto& [x, y, z] = *this->Boxes;
    const BlockId row = id / x.size();
    const BlockId box = x[id % x.size()] +
      (x.back() + BlockId(1)) * (y[row % y.size()] + (y.back() + BlockId(1)) * z[row / y.size()]);
    // Each rank gets one box of each round. Where it begins differs from round to round: else each rank would
    // get layers of boxes when their number along an axis is a multiple of the ranks', and a surface along
    // an axis would be one rank's alone.
    const BlockId shift = (box / this->Ranks * 0x9e3779b97f4a7c15u) >> 32;
    return static_cast<int>((box + shift) % this->Ranks);
  }

private:
  RoundRobinAssigner OneByOne;
  BlockId Ranks = 1;
  std::shared_ptr<const std::array<std::vector<std::uint32_t>, 3>> Boxes; ///< null: one by one
};

} // namespace dsm

#endif
