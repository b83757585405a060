// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_GridRay_h
#define rt_GridRay_h

#include "DSMBricks/base/Box.h"
#include "DSMRayTracing/base/Lanes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rt
{

/// A ray in index space: sample (i, j, k) lies at the point (i, j, k), so the planes between cells
/// are the whole numbers. T is that of the world ray.
///
/// The position where a ray crosses a plane is a function of the ray and the plane alone
/// (GetPlaneT), never a sum of steps. So cells, macrocells, bricks and coarser boxes agree bit for
/// bit where they meet, and the result for a ray does not depend on how the volume is divided.
///
/// The idle lane is an axis along which the ray does not move.
struct GridRay
{
  Lanes Origin;
  Lanes Direction;
  Lanes Inverse;
  /// Origin, but minus infinity for an axis along which the ray does not move: then the ray meets
  /// its planes at T = infinity without a case of its own.
  Lanes PlaneOrigin;
  /// 1 where the ray leaves a node through its upper plane, 0 where through the lower one.
  Lanes Forward;
  /// -1, 0 or 1.
  Lanes Step;

  IntegerLanes Backward; ///< axes along which Step is negative
  IntegerLanes Moving;   ///< axes along which Step is not 0

  /// Returns false when the ray has no direction or is not finite.
  bool Set(const double origin[3], const double direction[3])
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    this->Origin = Lanes(origin[0], origin[1], origin[2], 0.0);
    this->Direction = Lanes(direction[0], direction[1], direction[2], 0.0);
    this->Inverse = Lanes(1.0 / direction[0], 1.0 / direction[1], 1.0 / direction[2], infinity);
    this->PlaneOrigin = this->Origin;
    this->PlaneOrigin.Set(3, -infinity);
    this->Inverse.Set(3, 1.0);
    // Not finite when any of them is not.
    const double sum = this->Origin.GetSum() + this->Direction.GetSum();
    if (!(std::abs(sum) < infinity))
    {
      return false;
    }
    bool moves = true;
    if (!(std::abs(this->Inverse.GetSum()) < infinity))
    {
      moves = this->HoldStillAxes();
    }
    const Lanes none(0.0);
    this->Moving = this->PlaneOrigin > Lanes(-infinity);
    this->Backward = none > this->Direction;
    this->Forward = Lanes(1.0) - (Lanes(1.0) & this->Backward);
    this->Step = (Lanes(1.0) & this->Moving) - (Lanes(2.0) & this->Backward);
    return moves;
  }

  double GetPlaneT(int axis, double plane) const
  {
    return (plane - this->PlaneOrigin[axis]) * this->Inverse[axis];
  }
  Lanes GetPlaneT(const Lanes& planes) const
  {
    return (planes - this->PlaneOrigin) * this->Inverse;
  }
  Lanes GetPoint(double t) const { return this->Origin + Lanes(t) * this->Direction; }
  /// The index of a point of the ray, or of one a little ahead of it.
  Lanes GetIndex(const Lanes& point) const { return point; }
  /// Where in a cell the point at t is, from 0 to 1 but for rounding.
  Lanes GetWithin(const Lanes& cell, double t) const { return this->GetPoint(t) - cell; }

  /// Shortens [enter, leave] to the part inside of the box from 0 to `cells`; false when none of
  /// positive length is left.
  bool Clip(const bricks::Index3& cells, double& enter, double& leave) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto size = static_cast<double>(cells[axis]);
      if (this->Step[axis] == 0.0)
      {
        if (!(this->Origin[axis] >= 0.0 && this->Origin[axis] <= size))
        {
          return false;
        }
        continue;
      }
      const double a = this->GetPlaneT(axis, 0.0);
      const double b = this->GetPlaneT(axis, size);
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter < leave;
  }

private:
  /// Takes out the axes along which the ray moves too little for a division, or not at all; returns
  /// whether any other is left.
  bool HoldStillAxes()
  {
    bool moves = false;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (std::isfinite(this->Inverse[axis]))
      {
        moves = true;
        continue;
      }
      this->Direction.Set(axis, 0.0);
      this->Inverse.Set(axis, 1.0);
      this->PlaneOrigin.Set(axis, -std::numeric_limits<double>::infinity());
    }
    return moves;
  }
};

} // namespace rt

#endif
