// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/accel/BrickBvh.h"

#include "DSMBricks/accel/WideBvhBuilder.h"
#include "DSMCore/base/Error.h"

#include <string>

namespace bricks
{

BrickBvh::BrickBvh(const std::vector<BoundingBox>& bricks)
{
  constexpr std::size_t largest = std::size_t(1) << 29;
  if (bricks.size() > largest)
  {
    throw dsm::Error("A mesh of " + std::to_string(bricks.size()) +
      " bricks cannot be traced; the maximum is " + std::to_string(largest) +
      ". Use larger bricks.");
  }
  WideBvhBuilder<std::uint32_t> builder(1);
  builder.Build(bricks);
  this->Nodes = builder.GetNodes();
  const std::vector<std::uint32_t>& order = builder.GetOrder();
  for (Node& node : this->Nodes)
  {
    for (int child = 0; child < node.Children; ++child)
    {
      std::uint32_t& reference = node.References[child];
      if (reference & Node::LeafBit)
      {
        reference = Node::LeafBit | order[reference & ~Node::LeafBit];
      }
    }
  }
}

} // namespace bricks
