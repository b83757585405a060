// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ChildrenInRange_h
#define rt_ChildrenInRange_h

#include "DSMBricks/accel/RangedBvhNode.h"

#include <utility>

namespace rt
{

/// For TraverseWideBvh over RangedBvhNode: those of the children that `Boxes` finds (ChildrenOnRay) whose range of
/// values may hold what is looked for. `Predicate` decides that for a ValueRange, as IsovaluePredicate does; kept
/// by reference.
template <class Boxes, class Predicate>
class ChildrenInRange
{
public:
  ChildrenInRange(Boxes boxes, const Predicate& mayHold)
    : Met(std::move(boxes))
    , MayHold(mayHold)
  {
  }

  template <class Reference>
  unsigned FindChildren(
    const bricks::RangedBvhNode<Reference>& node, float enter[bricks::WideBvhWidth]) const
  {
    const unsigned met = this->Met.FindChildren(node, enter);
    unsigned found = 0;
    for (unsigned left = met; left != 0; left &= left - 1)
    {
      const int child = __builtin_ctz(left);
      found |= static_cast<unsigned>(this->MayHold(node.Ranges[child])) << child;
    }
    return found;
  }
  bool IsOpen(float enter) const { return this->Met.IsOpen(enter); }

private:
  Boxes Met;
  const Predicate& MayHold;
};

} // namespace rt

#endif
