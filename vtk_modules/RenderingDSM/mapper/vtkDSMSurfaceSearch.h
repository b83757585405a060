// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMSurfaceSearch_h
#define vtkDSMSurfaceSearch_h

#include "DSMBricks/layout/VoxelField.h"

#include <glm/mat4x4.hpp>

#include <vector>

/// Where a volume may have a surface, by what is known of its bricks; none of their values are needed.
class vtkDSMSurfaceSearch
{
public:
  /// Whether bricks that a box of world space meets (xmin, xmax, ymin, ...) may have a surface of one of the isovalues, which
  /// are in ascending order. Any thread, not collective.
  static bool MayFind(const bricks::VoxelField& field, const glm::dmat4& worldToIndex,
    const double bounds[6], const std::vector<double>& isovalues);
};

#endif
