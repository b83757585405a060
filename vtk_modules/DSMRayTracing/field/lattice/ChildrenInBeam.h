// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ChildrenInBeam_h
#define rt_ChildrenInBeam_h

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMRayTracing/field/lattice/RayBeam.h"

#include <cmath>

namespace rt
{

/// For TraverseWideBvh: children whose boxes rays of a beam may meet; with ranges: as ChildrenOnRay in
/// ChildrenInRange. Keeps a reference.
class ChildrenInBeam
{
public:
  explicit ChildrenInBeam(const RayBeam& beam)
    : Beam(beam)
  {
  }

  template <class Node>
  unsigned FindChildren(const Node& node, float enter[bricks::WideBvhWidth]) const
  {
    unsigned found = 0;
    for (int child = 0; child < node.Children; ++child)
    {
      double lower[3];
      double upper[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        const double step = std::ldexp(1.0, static_cast<int>(node.Exponent[axis]) - 127);
        const auto get = [&](int side)
        { return node.Origin[axis] + step * node.Bounds[(3 * side + axis) * Node::Width + child]; };
        lower[axis] = get(0);
        upper[axis] = get(1);
      }
      if (this->Beam.MayMeetBox(lower, upper))
      {
        enter[child] = static_cast<float>(this->Beam.GetEntry(lower, upper));
        found |= 1u << child;
      }
    }
    return found;
  }
  bool IsOpen(float) const { return true; }

private:
  const RayBeam& Beam;
};

} // namespace rt

#endif
