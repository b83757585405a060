// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PlaceInBrick_h
#define bricks_PlaceInBrick_h

#include "DSMBricks/layout/BrickSpace.h"

#include <cmath>

namespace bricks
{

/// Turns a position of a dataset into floats in the space of its bricks; zeros are positive. Returns whether all are
/// finite.
inline bool PlaceInBrick(const BrickSpace& space, const double position[3], float place[3])
{
  const double perUnit = 1.0 / space.Scale;
  bool isFinite = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    // Adding zero makes zeros positive.
    place[axis] = static_cast<float>((position[axis] - space.Origin[axis]) * perUnit) + 0.0f;
    isFinite = isFinite && std::isfinite(place[axis]);
  }
  return isFinite;
}

} // namespace bricks

#endif
