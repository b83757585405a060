// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MacrocellWalk_h
#define rt_MacrocellWalk_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/grid/GridRay.h"
#include "DSMRayTracing/field/grid/GridWalk.h"

#include <algorithm>

namespace rt
{

/// Takes a ray through the macrocells of a brick, whose first cell is `origin`, from `enter` to `leave`,
/// which differ and lie in the brick, or to `limit`. Calls `visit(walk, enter, leave)` for macrocells whose
/// range satisfies `mayHold`, until it returns true; returns whether it did.
template <class T, class Line, class Predicate, class Visit>
bool VisitMacrocells(const Line& line, const bricks::VoxelBrick<T>& brick, const Lanes& origin,
  double enter, double leave, double limit, const Predicate& mayHold, const Visit& visit)
{
  const int rows = brick.GetMacrocells(0);
  const int slices = brick.GetMacrocells(1);
  const NodeStrides strides(rows, rows * slices);
  const NodeGrid macrocells{ origin, bricks::MacrocellEdge, 1.0 / bricks::MacrocellEdge,
    Lanes(rows, slices, brick.GetMacrocells(2), 1.0), strides };
  GridWalk walk;
  const bricks::MacrocellRange<T>* range =
    brick.GetMacrocellRanges() + walk.Start(line, enter, macrocells);
  double t = enter;
  while (t < limit)
  {
    const double exit = std::min(walk.GetExit(), leave);
    if (mayHold(*range) && visit(walk, t, exit))
    {
      return true;
    }
    if (exit >= leave)
    {
      return false;
    }
    range += walk.Advance(line, exit);
    t = exit;
  }
  return false;
}

} // namespace rt

#endif
