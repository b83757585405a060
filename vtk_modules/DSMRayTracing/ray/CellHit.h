// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellHit_h
#define rt_CellHit_h

#include "DSMRayTracing/base/Lanes.h"

namespace rt
{

/// Intersection of a ray with an isosurface within a brick.
struct CellHit
{
  double T = 0.0;
  int Cell[3] = { 0, 0, 0 };         ///< position in the brick
  Lanes Local{ 0.0, 0.0, 0.0, 0.0 }; ///< within the cell, in [0, 1]
  bool FromInside = false;           ///< the ray comes from values that are not below the isovalue
};

} // namespace rt

#endif
