// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TrilinearIsosurface_h
#define rt_TrilinearIsosurface_h

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/Cubic.h"
#include "DSMRayTracing/field/grid/TrilinearCell.h"

namespace rt
{

///@{
/// Crossings of the trilinear function of the corners on the way from `start` to `end` (both in the cell, in [0,
/// 1]^3): see Cubic.h.
inline bool FindFirstCrossing(
  const double corners[8], const Lanes& start, const Lanes& end, double& s)
{
  return FindFirstCrossing(
    GetCubic(corners, start, end - start), EvaluateTrilinear(corners, end), s);
}
inline int CountCrossings(const double corners[8], const Lanes& start, const Lanes& end)
{
  return CountCrossings(GetCubic(corners, start, end - start), EvaluateTrilinear(corners, end));
}
inline bool HasCrossing(const double corners[8], const Lanes& start, const Lanes& end)
{
  return HasCrossing(GetCubic(corners, start, end - start), EvaluateTrilinear(corners, end));
}
///@}

} // namespace rt

#endif
