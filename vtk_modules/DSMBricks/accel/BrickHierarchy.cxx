// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/accel/BrickHierarchy.h"

#include "DSMBricks/accel/WideBvhBuilder.h"
#include "DSMCore/base/Error.h"

#include <string>
#include <utility>

namespace bricks
{

template <bool HasRanges>
BrickHierarchy<HasRanges>::BrickHierarchy(
  const std::vector<BoundingBox>& boxes, const std::vector<ValueRange>& ranges)
{
  constexpr std::size_t largest = std::size_t(1) << 29;
  if (boxes.size() > largest)
  {
    throw dsm::Error(std::to_string(boxes.size()) + " bricks cannot be traced; the maximum is " +
      std::to_string(largest) + ". Use larger bricks.");
  }
  WideBvhBuilder<std::uint32_t> builder(1);
  builder.Build(boxes);
  std::vector<WideBvhNode<std::uint32_t>> nodes = builder.GetNodes();
  const std::vector<std::uint32_t>& order = builder.GetOrder();
  for (WideBvhNode<std::uint32_t>& node : nodes)
  {
    for (int child = 0; child < node.Children; ++child)
    {
      std::uint32_t& reference = node.References[child];
      if (reference & Node::LeafBit)
      {
        reference = Node::LeafBit | order[GetBrick(reference)];
      }
    }
  }
  if constexpr (HasRanges)
  {
    this->Ranges = ranges;
    for (const ValueRange& range : ranges)
    {
      this->All.Add(range);
    }
    this->Nodes =
      AddRanges(nodes, [this](std::uint32_t leaf) { return this->GetRange(GetBrick(leaf)); });
  }
  else
  {
    this->Nodes = std::move(nodes);
  }
}

template class BrickHierarchy<false>;
template class BrickHierarchy<true>;

} // namespace bricks
