// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_BrickHierarchy_h
#define bricks_BrickHierarchy_h

#include "DSMBricks/accel/BoundingBox.h"
#include "DSMBricks/accel/RangedBvhNode.h"
#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/base/ValueRange.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace bricks
{

/// The bounding volume hierarchy over bricks, whole on every rank (the paper, section 4.3, keeps one hierarchy over
/// all triangles in shared memory; we share only its lower part, the treelets in the bricks). A leaf is one brick.
/// With ranges, each node has those of the values below its children, and each brick its own.
template <bool HasRanges>
class BrickHierarchy
{
public:
  using Node =
    std::conditional_t<HasRanges, RangedBvhNode<std::uint32_t>, WideBvhNode<std::uint32_t>>;

  BrickHierarchy() = default;
  /// Boxes and ranges of the bricks, by their numbers; no box is empty. Without ranges, `ranges` are left out. Throws
  /// dsm::Error for more than 2^29 bricks.
  explicit BrickHierarchy(
    const std::vector<BoundingBox>& boxes, const std::vector<ValueRange>& ranges = {});

  bool IsEmpty() const { return this->Nodes.empty(); }
  /// The first one is the root.
  const Node* GetNodes() const { return this->Nodes.data(); }
  std::size_t GetBytes() const { return this->Nodes.size() * sizeof(Node); }

  /// The number of the brick that a leaf refers to.
  static std::uint32_t GetBrick(std::uint32_t leaf) { return leaf & ~Node::LeafBit; }

  ///@{
  /// With ranges: that of a brick, those of the bricks by their numbers, and that of all.
  const ValueRange& GetRange(std::uint64_t brick) const
  {
    return this->Ranges[static_cast<std::size_t>(brick)];
  }
  const std::vector<ValueRange>& GetRanges() const { return this->Ranges; }
  const ValueRange& GetRange() const { return this->All; }
  ///@}

private:
  std::vector<Node> Nodes;
  std::vector<ValueRange> Ranges;
  ValueRange All = ValueRange::GetEmpty();
};

extern template class BrickHierarchy<false>;
extern template class BrickHierarchy<true>;

/// For meshes: rays look for no values in their bricks.
using BrickBvh = BrickHierarchy<false>;
/// For fields.
using RangedBrickBvh = BrickHierarchy<true>;

} // namespace bricks

#endif
