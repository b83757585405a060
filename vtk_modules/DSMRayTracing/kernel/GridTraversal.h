// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_GridTraversal_h
#define rt_GridTraversal_h

#include "DSMRayTracing/brick/VoxelBrick.h"
#include "DSMRayTracing/kernel/CellHit.h"
#include "DSMRayTracing/kernel/GridRay.h"
#include "DSMRayTracing/kernel/GridWalk.h"
#include "DSMRayTracing/kernel/IsovalueLevel.h"
#include "DSMRayTracing/kernel/TrilinearIsosurface.h"

namespace rt
{

/// A ray in one brick: over its macrocells, then over the cells of those that the isovalue is in.
template <class T>
class GridTraversal
{
public:
  /// `origin`: the brick's first cell.
  GridTraversal(const GridRay& ray, const VoxelBrick<T>& brick, const int origin[3])
    : Line(ray)
    , Brick(brick)
    , Origin{ origin[0], origin[1], origin[2] }
    , CellStrides{ ray.Step[0], ray.Step[1] * brick.GetRow(), ray.Step[2] * brick.GetSlice() }
  {
  }

  /// The first hit in [enter, leave], which is not empty and lies in the brick. Gives up at `limit`,
  /// from which on hits are of no interest, though it may find one there.
  bool FindFirst(
    const IsovalueLevel<T>& level, double enter, double leave, double limit, CellHit& hit) const
  {
    const int counts[3] = { this->Brick.GetMacrocells(0), this->Brick.GetMacrocells(1),
      this->Brick.GetMacrocells(2) };
    const int strides[3] = { this->Line.Step[0], this->Line.Step[1] * counts[0],
      this->Line.Step[2] * counts[0] * counts[1] };
    int node[3];
    double lower[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      node[axis] = this->Line.Locate(
        axis, enter, this->Origin[axis], MacrocellEdge, 1.0 / MacrocellEdge, counts[axis]);
      lower[axis] = this->Origin[axis] + node[axis] * MacrocellEdge;
    }
    const MacrocellRange<T>* range =
      this->Brick.GetMacrocellRanges() + node[0] + counts[0] * (node[1] + counts[1] * node[2]);
    GridWalk walk(this->Line, lower, MacrocellEdge);
    double t = enter;
    while (t < limit)
    {
      const double exit = std::min(walk.GetExit(), leave);
      if (level.Separates(range->Min, range->Max) && this->WalkCells(level, walk, t, exit, hit))
      {
        return true;
      }
      if (exit >= leave)
      {
        return false;
      }
      range += walk.Advance(this->Line, exit, strides);
      t = exit;
    }
    return false;
  }

private:
  /// The first hit in the macrocell of `macrocells`, which the ray crosses from enter to leave.
  bool WalkCells(const IsovalueLevel<T>& level, const GridWalk& macrocells, double enter,
    double leave, CellHit& hit) const
  {
    int local[3];
    double lower[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const int first = static_cast<int>(macrocells.GetLower(this->Line, axis, MacrocellEdge));
      const int count =
        std::min(MacrocellEdge, this->Origin[axis] + this->Brick.GetCells(axis) - first);
      const int cell = first + this->Line.Locate(axis, enter, first, 1, 1.0, count);
      lower[axis] = cell;
      local[axis] = cell - this->Origin[axis];
    }
    const T* corner =
      this->Brick.GetSamples() + this->Brick.GetOffset(local[0], local[1], local[2]);
    GridWalk walk(this->Line, lower, 1.0);
    double t = enter;
    for (;;)
    {
      const double exit = std::min(walk.GetExit(), leave);
      if (this->IsSeparated(level, corner) && this->IntersectCell(level, walk, t, exit, hit))
      {
        return true;
      }
      if (exit >= leave)
      {
        return false;
      }
      corner += walk.Advance(this->Line, exit, this->CellStrides);
      t = exit;
    }
  }

  /// Whether the corners of the cell whose first one is given are on both sides.
  bool IsSeparated(const IsovalueLevel<T>& level, const T* corner) const
  {
    const T* upper = corner + this->Brick.GetSlice();
    const int row = this->Brick.GetRow();
    const int inside = level.IsInside(corner[0]) + level.IsInside(corner[1]) +
      level.IsInside(corner[row]) + level.IsInside(corner[row + 1]) + level.IsInside(upper[0]) +
      level.IsInside(upper[1]) + level.IsInside(upper[row]) + level.IsInside(upper[row + 1]);
    return (inside & 7) != 0;
  }

  /// Where the ray is in a cell at t: exactly 0 or 1 where it meets a plane.
  double GetLocal(int axis, int cell, double t) const
  {
    if (t == this->Line.GetPlaneT(axis, cell))
    {
      return 0.0;
    }
    if (t == this->Line.GetPlaneT(axis, cell + 1.0))
    {
      return 1.0;
    }
    return std::clamp(this->Line.GetCoordinate(axis, t) - cell, 0.0, 1.0);
  }

  /// The first hit in a cell, which the ray crosses from enter to leave.
  bool IntersectCell(const IsovalueLevel<T>& level, const GridWalk& cells, double enter,
    double leave, CellHit& hit) const
  {
    int cell[3];
    int local[3];
    double start[3];
    double end[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      cell[axis] = static_cast<int>(cells.GetLower(this->Line, axis, 1.0));
      local[axis] = cell[axis] - this->Origin[axis];
      start[axis] = this->GetLocal(axis, cell[axis], enter);
      end[axis] = this->GetLocal(axis, cell[axis], leave);
    }
    if (!this->Brick.HoldsData(local[0], local[1], local[2]))
    {
      return false;
    }
    double corners[8];
    for (int corner = 0; corner < 8; ++corner)
    {
      corners[corner] = level.Subtract(this->Brick.GetSample(
        local[0] + (corner & 1), local[1] + (corner >> 1 & 1), local[2] + (corner >> 2)));
    }
    double s;
    if (!FindFirstCrossing(corners, start, end, s))
    {
      return false;
    }
    hit.T = std::min(enter + s * (leave - enter), leave);
    for (int axis = 0; axis < 3; ++axis)
    {
      hit.Cell[axis] = cell[axis];
      hit.Local[axis] = std::clamp(start[axis] + s * (end[axis] - start[axis]), 0.0, 1.0);
    }
    return true;
  }

  const GridRay& Line;
  const VoxelBrick<T>& Brick;
  int Origin[3];
  int CellStrides[3];
};

} // namespace rt

#endif
