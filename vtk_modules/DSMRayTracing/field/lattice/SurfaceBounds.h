// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SurfaceBounds_h
#define rt_SurfaceBounds_h

#include "DSMBricks/layout/VoxelField.h"

#include <glm/mat4x4.hpp>

#include <vector>

namespace rt
{

/// Whether bricks that a box of world space meets (xmin, xmax, ymin, ...) may have a surface of one of the isovalues, which
/// are in ascending order: by what is known of the bricks, none of their values are needed. Any thread, not collective.
bool MayHaveSurface(const bricks::VoxelField& field, const glm::dmat4& worldToIndex,
  const double bounds[6], const std::vector<double>& isovalues);

} // namespace rt

#endif
