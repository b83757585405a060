// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ChildrenOnRay_h
#define rt_ChildrenOnRay_h

#include "DSMRayTracing/ray/BoxRay.h"

namespace rt
{

/// For TraverseWideBvh: children whose boxes a ray meets within [0, last]. All is kept by reference; `last` may be
/// lowered during the walk.
class ChildrenOnRay
{
public:
  ChildrenOnRay(const BoxRay& ray, const float& last)
    : Ray(ray)
    , Last(last)
  {
  }

  template <class Node>
  unsigned FindChildren(const Node& node, float enter[bricks::WideBvhWidth]) const
  {
    return this->Ray.FindChildren(node, this->Last, enter);
  }
  bool IsOpen(float enter) const { return enter <= this->Last; }

private:
  const BoxRay& Ray;
  const float& Last;
};

} // namespace rt

#endif
