// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SurfaceBounds_h
#define rt_SurfaceBounds_h

#include "DSMBricks/layout/VoxelField.h"

#include <glm/mat4x4.hpp>

#include <vector>

namespace rt
{

/// Returns whether bricks that overlap a box in world space (xmin, xmax, ymin, ...) may have a
/// surface of one of the isovalues, which are in ascending order. Uses the bricks' ranges only,
/// none of their values. Any thread, not collective.
bool MayHaveSurface(const bricks::VoxelField& field, const glm::dmat4& worldToIndex,
  const double bounds[6], const std::vector<double>& isovalues);

} // namespace rt

#endif
