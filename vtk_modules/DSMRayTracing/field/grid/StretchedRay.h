// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_StretchedRay_h
#define rt_StretchedRay_h

#include "DSMBricks/layout/GridPlanes.h"
#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/grid/GridRay.h"

#include <cstddef>

namespace rt
{

/// A ray in the grid space of a rectilinear grid (bricks::GridPlanes). Planes and cells are named by their indices, as
/// those of a GridRay are; the ray's points are in grid space.
struct StretchedRay : GridRay
{
  /// Keeps a reference.
  explicit StretchedRay(const bricks::GridPlanes& planes)
    : Planes(planes)
  {
  }

  double GetPlaneT(int axis, double plane) const
  {
    return this->GridRay::GetPlaneT(axis, this->Planes.GetPlace(axis, plane));
  }
  Lanes GetPlaneT(const Lanes& planes) const
  {
    return this->GridRay::GetPlaneT(this->GetPlaces(planes));
  }
  Lanes GetIndex(const Lanes& point) const
  {
    return { this->Planes.ToIndex(0, point[0]), this->Planes.ToIndex(1, point[1]),
      this->Planes.ToIndex(2, point[2]), 0.0 };
  }
  Lanes GetWithin(const Lanes& cell, double t) const
  {
    const auto getInverse = [&](int axis)
    { return this->Planes.GetInverseWidths(axis)[static_cast<std::size_t>(cell[axis])]; };
    return (this->GetPoint(t) - this->GetPlaces(cell)) *
      Lanes(getInverse(0), getInverse(1), getInverse(2), 1.0);
  }

private:
  Lanes GetPlaces(const Lanes& planes) const
  {
    return { this->Planes.GetPlace(0, planes[0]), this->Planes.GetPlace(1, planes[1]),
      this->Planes.GetPlace(2, planes[2]), 0.0 };
  }

  const bricks::GridPlanes& Planes;
};

} // namespace rt

#endif
