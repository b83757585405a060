// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellHit_h
#define rt_CellHit_h

namespace rt
{

/// Where a ray meets an isosurface, in index space.
struct CellHit
{
  double T = 0.0;
  int Cell[3] = { 0, 0, 0 };           ///< of the volume
  double Local[3] = { 0.0, 0.0, 0.0 }; ///< within the cell, in [0, 1]
};

} // namespace rt

#endif
