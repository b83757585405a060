// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_GridRay_h
#define rt_GridRay_h

#include "DSMRayTracing/brick/Box.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rt
{

/// A ray in index space: sample (i, j, k) lies at the point (i, j, k), so the planes between cells
/// are the whole numbers. T is that of the world ray.
///
/// Where a ray crosses a plane is a function of the ray and the plane alone (PlaneT), never a sum of
/// steps. So cells, macrocells, bricks and coarser boxes agree bit for bit where they meet, and what
/// a ray finds does not depend on how the volume is cut.
struct GridRay
{
  double Origin[3];
  double Direction[3];
  double Inverse[3];
  /// Origin, but minus infinity for an axis along which the ray does not move: then the ray meets
  /// its planes at T = infinity without a case of its own.
  double PlaneOrigin[3];
  /// -1, 0 or 1.
  int Step[3];

  /// Returns false when the ray has no direction or is not finite.
  bool Set(const double origin[3], const double direction[3])
  {
    bool moves = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (!std::isfinite(origin[axis]) || !std::isfinite(direction[axis]))
      {
        return false;
      }
      this->Origin[axis] = origin[axis];
      this->Direction[axis] = direction[axis];
      this->Inverse[axis] = 1.0 / direction[axis];
      this->PlaneOrigin[axis] = origin[axis];
      this->Step[axis] = direction[axis] > 0.0 ? 1 : -1;
      if (!std::isfinite(this->Inverse[axis]))
      {
        this->Direction[axis] = 0.0;
        this->Inverse[axis] = 1.0;
        this->PlaneOrigin[axis] = -std::numeric_limits<double>::infinity();
        this->Step[axis] = 0;
      }
      moves = moves || this->Step[axis] != 0;
    }
    return moves;
  }

  double GetPlaneT(int axis, double plane) const
  {
    return (plane - this->PlaneOrigin[axis]) * this->Inverse[axis];
  }
  double GetCoordinate(int axis, double t) const
  {
    return this->Origin[axis] + t * this->Direction[axis];
  }

  /// Shortens [enter, leave] to the part inside of the box from 0 to `cells`; false when none of
  /// positive length is left.
  bool Clip(const Index3& cells, double& enter, double& leave) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto size = static_cast<double>(cells[axis]);
      if (this->Step[axis] == 0)
      {
        if (!(this->Origin[axis] >= 0.0 && this->Origin[axis] <= size))
        {
          return false;
        }
        continue;
      }
      const bool forward = this->Step[axis] > 0;
      enter = std::max(enter, this->GetPlaneT(axis, forward ? 0.0 : size));
      leave = std::min(leave, this->GetPlaneT(axis, forward ? size : 0.0));
    }
    return enter < leave;
  }

  /// Along one axis, the node in which the ray goes on at t: of a row of `count` nodes of `edge`
  /// cells that begins at the plane `first`. Planes that are met at t or before count as crossed.
  int Locate(int axis, double t, int first, int edge, double inverseEdge, int count) const
  {
    const double place = (this->GetCoordinate(axis, t) - first) * inverseEdge;
    int node = static_cast<int>(std::clamp(place, 0.0, count - 1.0));
    const int step = this->Step[axis];
    if (step == 0)
    {
      return node;
    }
    // The rounding of `place` may differ by a node from what GetPlaneT says, which decides.
    const int ahead = step > 0 ? 1 : 0;
    const int behind = 1 - ahead;
    const auto planeT = [&](int plane) { return this->GetPlaneT(axis, first + plane * edge); };
    const int last = step > 0 ? count - 1 : 0;
    while (node != last && planeT(node + ahead) <= t)
    {
      node += step;
    }
    const int begin = count - 1 - last;
    while (node != begin && planeT(node + behind) > t)
    {
      node -= step;
    }
    return node;
  }
};

} // namespace rt

#endif
