// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_GridWalk_h
#define rt_GridWalk_h

#include "DSMRayTracing/kernel/GridRay.h"

namespace rt
{

/// Walks the nodes (cells, macrocells) of a grid in the order in which a ray meets them. Where the
/// ray passes through an edge or a corner it steps over all planes at once, so that no node is
/// visited for a single point.
class GridWalk
{
public:
  /// Starts in the node whose lower planes are at `lower` and upper ones at `lower + edge`.
  GridWalk(const GridRay& ray, const double lower[3], double edge)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Plane[axis] = lower[axis] + (ray.Step[axis] < 0 ? 0.0 : edge);
      this->Stride[axis] = ray.Step[axis] * edge;
      this->PlaneT[axis] = ray.GetPlaneT(axis, this->Plane[axis]);
    }
  }

  /// Where the ray leaves the current node.
  double GetExit() const
  {
    return std::min(std::min(this->PlaneT[0], this->PlaneT[1]), this->PlaneT[2]);
  }

  /// Goes on to the node after `exit`. Returns the change of an index that changes by
  /// `strides[axis]` for a step along the ray on an axis.
  int Advance(const GridRay& ray, double exit, const int strides[3])
  {
    int change = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool crossed = this->PlaneT[axis] <= exit;
      change += crossed ? strides[axis] : 0;
      this->Plane[axis] += crossed ? this->Stride[axis] : 0.0;
      this->PlaneT[axis] = ray.GetPlaneT(axis, this->Plane[axis]);
    }
    return change;
  }

  /// The lower plane of the current node.
  double GetLower(const GridRay& ray, int axis, double edge) const
  {
    return this->Plane[axis] - (ray.Step[axis] < 0 ? 0.0 : edge);
  }

private:
  double Plane[3];  ///< coordinate of the plane through which the ray leaves on each axis
  double PlaneT[3]; ///< where it meets that plane
  double Stride[3];
};

} // namespace rt

#endif
