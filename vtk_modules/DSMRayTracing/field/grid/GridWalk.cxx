// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/grid/GridWalk.h"

#include "DSMRayTracing/field/grid/StretchedRay.h"

namespace rt
{

template <class Line>
void GridWalk::Correct(const Line& ray, double t, const NodeGrid& grid, Lanes& nodes)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double step = ray.Step[axis];
    const double first = grid.First[axis];
    const double forward = ray.Forward[axis];
    const double last = step > 0.0 ? grid.Counts[axis] - 1.0 : 0.0;
    const double begin = grid.Counts[axis] - 1.0 - last;
    const auto planeT = [&](double plane)
    { return ray.GetPlaneT(axis, first + plane * grid.Edge); };
    double node = nodes[axis];
    while (step != 0.0 && node != last && planeT(node + forward) <= t)
    {
      node += step;
    }
    while (step != 0.0 && node != begin && planeT(node + 1.0 - forward) > t)
    {
      node -= step;
    }
    nodes.Set(axis, node);
  }
  this->Plane = grid.First + (nodes + ray.Forward) * Lanes(grid.Edge);
  this->PlaneT = ray.GetPlaneT(this->Plane);
}

template void GridWalk::Correct(const GridRay&, double, const NodeGrid&, Lanes&);
template void GridWalk::Correct(const StretchedRay&, double, const NodeGrid&, Lanes&);

} // namespace rt
