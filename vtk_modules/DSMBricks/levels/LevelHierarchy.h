// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_LevelHierarchy_h
#define bricks_LevelHierarchy_h

#include "DSMBricks/accel/RangedBvhNode.h"
#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/levels/LevelLattice.h"

#include <cstdint>
#include <vector>

namespace bricks
{

/// The hierarchy of boxes and ranges over the bricks of all levels, whole on every rank. A leaf is one brick. Boxes
/// are in cells of level 0.
class LevelHierarchy
{
public:
  using Node = RangedBvhNode<std::uint32_t>;

  LevelHierarchy() = default;
  /// `ranges`: of the bricks, by their numbers.
  LevelHierarchy(const LevelLattice& lattice, std::vector<ValueRange> ranges);

  bool IsEmpty() const { return this->Nodes.empty(); }
  /// The first one is the root.
  const std::vector<Node>& GetNodes() const { return this->Nodes; }
  const ValueRange& GetRange(dsm::BlockId id) const
  {
    return this->Ranges[static_cast<std::size_t>(id)];
  }
  /// Returns the ranges of the bricks, by their numbers.
  const std::vector<ValueRange>& GetRanges() const { return this->Ranges; }
  /// Returns the range of all bricks.
  const ValueRange& GetRange() const { return this->All; }
  /// The number of the brick that a leaf refers to.
  static dsm::BlockId GetBrick(std::uint32_t leaf) { return leaf & ~Node::LeafBit; }

private:
  std::vector<Node> Nodes;
  std::vector<ValueRange> Ranges;
  ValueRange All = ValueRange::GetEmpty();
};

} // namespace bricks

#endif
