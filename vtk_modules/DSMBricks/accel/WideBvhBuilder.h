// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_WideBvhBuilder_h
#define bricks_WideBvhBuilder_h

#include "DSMBricks/accel/BoundingBox.h"
#include "DSMBricks/accel/WideBvhNode.h"

#include <cstdint>
#include <vector>

namespace bricks
{

/// How a hierarchy is built.
enum class WideBvhShape
{
  ByArea, ///< with the surface area heuristic over bins (Wald 2007); a node splits its largest child until it has eight
  Full ///< in the fewest nodes: all but the last of a level have eight children; split where their longest edge is
};

/// Builds hierarchies of wide nodes, top down. One for each thread; keeps its storage from one hierarchy to the next.
///
/// The result depends on the boxes and their order alone.
template <class Reference>
class WideBvhBuilder
{
public:
  using Node = WideBvhNode<Reference>;

  /// `leafSize`: items that are intersected together, at most four.
  explicit WideBvhBuilder(std::uint32_t leafSize, WideBvhShape shape = WideBvhShape::ByArea)
    : LeafSize(leafSize)
    , Shape(shape)
  {
  }

  /// The hierarchy over the boxes of items 0, 1, ...; no item has an empty box.
  void Build(const std::vector<BoundingBox>& boxes);

  /// The first one is the root; none when there are no items.
  const std::vector<Node>& GetNodes() const { return this->Nodes; }
  /// The items in the order of the leaves: a leaf with items [first, first + count) of this order
  /// is referred to by GetLeaf(first, count).
  const std::vector<std::uint32_t>& GetOrder() const { return this->Order; }

  static Reference GetLeaf(std::uint32_t first, std::uint32_t count)
  {
    const std::uint32_t countBits = (count - 1) << (8 * sizeof(Reference) - 3);
    return static_cast<Reference>(Node::LeafBit | countBits | first);
  }

private:
  /// Items [Begin, End) of Order.
  struct Range
  {
    std::uint32_t Begin = 0;
    std::uint32_t End = 0;
    BoundingBox Box;
    BoundingBox Centers; ///< of the items' boxes, times two

    std::uint32_t GetCount() const { return this->End - this->Begin; }
  };

  static constexpr int Bins = 16;
  /// A node deeper than this is cut in halves by number, so that the depth is bounded however the
  /// items lie: see WideBvhTraversal.
  static constexpr int LargestSplitDepth = 20;

  Reference BuildNode(const Range& range, int depth);
  void Split(const Range& range, bool byNumber, std::uint32_t step, Range& first, Range& second);
  /// Parts items across the longest edge of the box of their centers. Returns where: behind `step` items or a multiple
  /// of that, about in the middle.
  std::uint32_t SplitFull(const Range& range, std::uint32_t step);
  /// False when no plane parts the items.
  bool FindPlane(const Range& range, int& axis, int& bin) const;
  Range Measure(std::uint32_t begin, std::uint32_t end) const;
  void SetBounds(Node& node, const BoundingBox& box, const Range* children, int count) const;

  std::uint32_t LeafSize;
  WideBvhShape Shape;
  const BoundingBox* Boxes = nullptr;
  std::vector<std::uint32_t> Order;
  std::vector<Node> Nodes;
};

extern template class WideBvhBuilder<std::uint16_t>;
extern template class WideBvhBuilder<std::uint32_t>;

} // namespace bricks

#endif
