// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_BrickBvh_h
#define bricks_BrickBvh_h

#include "DSMBricks/accel/BoundingBox.h"
#include "DSMBricks/accel/WideBvhNode.h"

#include <cstdint>
#include <vector>

namespace bricks
{

/// The bounding volume hierarchy over the bricks of a mesh, whole on every rank (the paper, section
/// 4.3, keeps one hierarchy over all triangles in shared memory; we share only its lower part, the
/// treelets in the bricks). A leaf is one brick.
class BrickBvh
{
public:
  using Node = WideBvhNode<std::uint32_t>;

  BrickBvh() = default;
  /// By number of the brick; none is empty. Throws dsm::Error for more than 2^29 bricks.
  explicit BrickBvh(const std::vector<BoundingBox>& bricks);

  bool IsEmpty() const { return this->Nodes.empty(); }
  /// The first one is the root.
  const Node* GetNodes() const { return this->Nodes.data(); }
  std::size_t GetBytes() const { return this->Nodes.size() * sizeof(Node); }

  /// The number of the brick that a leaf refers to.
  static std::uint32_t GetBrick(std::uint32_t leaf) { return leaf & ~Node::LeafBit; }

private:
  std::vector<Node> Nodes;
};

} // namespace bricks

#endif
