// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_RangedBvhNode_h
#define bricks_RangedBvhNode_h

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/base/ValueRange.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bricks
{

/// A node of a hierarchy over items that have values, as cells of a grid: all values below child *i* are in Ranges[i].
template <class Reference>
struct RangedBvhNode : WideBvhNode<Reference>
{
  ValueRange Ranges[WideBvhWidth];

  /// Returns the range over all children.
  ValueRange GetRange() const
  {
    ValueRange all = ValueRange::GetEmpty();
    for (int child = 0; child < this->Children; ++child)
    {
      all.Add(this->Ranges[child]);
    }
    return all;
  }
};

static_assert(sizeof(RangedBvhNode<std::uint16_t>) == 144, "no padding");
static_assert(sizeof(RangedBvhNode<std::uint32_t>) == 160, "no padding");

/// The nodes of a hierarchy, in which children stand behind their parents (WideBvhBuilder), with ranges.
/// `getRange(reference)`: of the items of a leaf.
template <class Reference, class GetRange>
std::vector<RangedBvhNode<Reference>> AddRanges(
  const std::vector<WideBvhNode<Reference>>& nodes, const GetRange& getRange)
{
  std::vector<RangedBvhNode<Reference>> ranged(nodes.size());
  for (std::size_t index = nodes.size(); index-- > 0;)
  {
    RangedBvhNode<Reference>& node = ranged[index];
    static_cast<WideBvhNode<Reference>&>(node) = nodes[index];
    for (int child = 0; child < node.Children; ++child)
    {
      const Reference reference = node.References[child];
      node.Ranges[child] =
        reference & node.LeafBit ? getRange(reference) : ranged[reference].GetRange();
    }
  }
  return ranged;
}

} // namespace bricks

#endif
