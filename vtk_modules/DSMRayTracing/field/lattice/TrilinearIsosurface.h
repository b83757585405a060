// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TrilinearIsosurface_h
#define rt_TrilinearIsosurface_h

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/lattice/TrilinearCell.h"

namespace rt
{

/// The first place s in [0, 1] on the way from `start` to `end` (both in the cell, in [0, 1]^3)
/// where the trilinear function of the corners changes its side; values >= 0 are inside. Returns
/// false when it does not.
///
/// A change between the two ends always yields a place, whatever rounding does in between. Two
/// changes within the cell are found through the extrema of the cubic (Marmitt et al. 2004, "Fast
/// and accurate ray-voxel intersection techniques for iso-surface ray tracing").
bool FindFirstCrossing(const double corners[8], const Lanes& start, const Lanes& end, double& s);

/// How often the function changes its side on that way: 0 to 3.
int CountCrossings(const double corners[8], const Lanes& start, const Lanes& end);

/// Returns whether FindFirstCrossing would find a crossing, without computing its position.
bool HasCrossing(const double corners[8], const Lanes& start, const Lanes& end);

} // namespace rt

#endif
