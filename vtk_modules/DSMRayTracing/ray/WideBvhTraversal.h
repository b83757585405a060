// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WideBvhTraversal_h
#define rt_WideBvhTraversal_h

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMRayTracing/ray/BoxRay.h"

#include <utility>

namespace rt
{

/// A level leaves at most seven children behind. The builder bounds the depth: 21 levels, and then
/// those in which a node has an eighth of its parent's items, at most 11 for 2^32 items.
constexpr int LargestWideBvhDepth = 33;

/// Visits the leaves of a hierarchy whose boxes a ray meets within [0, last], nearest box first.
/// `visit(reference)` may lower `last`. Kernels under it must be inlined: no call but the leaf's.
template <class Reference, class Visit>
inline void TraverseWideBvh(
  const bricks::WideBvhNode<Reference>* nodes, const BoxRay& ray, const float& last, Visit&& visit)
{
  using Node = bricks::WideBvhNode<Reference>;
  struct Entry
  {
    float Enter;
    Reference Child;
  };
  Entry stack[(Node::Width - 1) * LargestWideBvhDepth + Node::Width];
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
      unsigned met = ray.FindChildren(node, last, enter);
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
    } while (stack[size].Enter > last);
    child = stack[size].Child;
  }
}

} // namespace rt

#endif
