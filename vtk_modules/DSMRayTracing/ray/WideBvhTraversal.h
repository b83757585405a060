// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WideBvhTraversal_h
#define rt_WideBvhTraversal_h

#include "DSMBricks/accel/WideBvhNode.h"

#include <utility>

namespace rt
{

/// A level leaves at most seven children behind. The builder bounds the depth: 21 levels, and then
/// those in which a node has an eighth of its parent's items, at most 11 for 2^32 items.
constexpr int LargestWideBvhDepth = 33;
/// Children that wait at a time, at most.
constexpr int LargestWideBvhStack =
  (bricks::WideBvhWidth - 1) * LargestWideBvhDepth + bricks::WideBvhWidth;

/// Visits the leaves of a hierarchy that `wanted` selects, nearest first: see ChildrenOnRay and ChildrenInRange. It
/// has
/// - unsigned FindChildren(node, float enter[WideBvhWidth]): bit i set when child i may have what is looked for;
///   `enter` tells where;
/// - bool IsOpen(float enter): whether a child there still may, when its turn comes.
/// `visit(reference)` may change its answers, so that fewer are wanted. Kernels under it must be inlined: no call
/// but the leaf's.
template <class Node, class Wanted, class Visit>
inline void TraverseWideBvh(const Node* nodes, const Wanted& wanted, Visit&& visit)
{
  using Reference = typename Node::ReferenceType;
  struct Entry
  {
    float Enter;
    Reference Child;
  };
  Entry stack[LargestWideBvhStack];
  int size = 0;
  Reference child = 0;
  while (true)
  {
    if (child & Node::LeafBit)
    {
      visit(child);
    }
    else
    {
      const Node& node = nodes[child];
      float enter[Node::Width];
      unsigned met = wanted.FindChildren(node, enter);
      if (met != 0)
      {
        // The nearest child is next; the others wait, the nearer ones on top.
        int slot = __builtin_ctz(met);
        Entry nearest{ enter[slot], node.References[slot] };
        const int bottom = size;
        for (met &= met - 1; met != 0; met &= met - 1)
        {
          slot = __builtin_ctz(met);
          Entry entry{ enter[slot], node.References[slot] };
          if (entry.Enter < nearest.Enter)
          {
            std::swap(entry, nearest);
          }
          int place = size++;
          for (; place > bottom && stack[place - 1].Enter < entry.Enter; --place)
          {
            stack[place] = stack[place - 1];
          }
          stack[place] = entry;
        }
        child = nearest.Child;
        continue;
      }
    }
    do
    {
      if (size == 0)
      {
        return;
      }
      --size;
    } while (!wanted.IsOpen(stack[size].Enter));
    child = stack[size].Child;
  }
}

} // namespace rt

#endif
