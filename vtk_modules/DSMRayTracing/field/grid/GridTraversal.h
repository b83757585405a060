// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_GridTraversal_h
#define rt_GridTraversal_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/grid/BrickCells.h"
#include "DSMRayTracing/field/grid/CornerTest.h"
#include "DSMRayTracing/field/grid/GridRay.h"
#include "DSMRayTracing/field/grid/GridWalk.h"
#include "DSMRayTracing/field/grid/IsovalueLevel.h"
#include "DSMRayTracing/field/grid/TrilinearIsosurface.h"
#include "DSMRayTracing/ray/CellHit.h"

namespace rt
{

/// Traverses one brick along a ray: its macrocells, then the cells of those whose range contains the
/// isovalue.
template <class T, class Ray = GridRay>
class GridTraversal
{
public:
  /// `origin`: the brick's first cell.
  GridTraversal(const Ray& ray, const bricks::VoxelBrick<T>& brick, const Lanes& origin)
    : Cells(ray, brick, origin)
  {
  }

  /// The first hit in [enter, leave], which is not empty and lies in the brick. Gives up at `limit`,
  /// from which on hits are of no interest, though it may find one there.
  bool FindFirst(
    const IsovalueLevel<T>& level, double enter, double leave, double limit, CellHit& hit) const
  {
    return this->Walk(level, enter, leave, limit,
      [&](const GridWalk& cells, const T* corner, double in, double out)
      { return this->IntersectCell(level, cells, corner, in, out, hit); });
  }

  /// Returns whether there is a hit in [enter, leave].
  bool HasHit(const IsovalueLevel<T>& level, double enter, double leave) const
  {
    return this->Walk(level, enter, leave, leave,
      [&](const GridWalk& cells, const T* corner, double in, double out)
      {
        double corners[8];
        Lanes start;
        Lanes end;
        return this->EnterCell(level, cells, corner, in, out, corners, start, end) &&
          HasCrossing(corners, start, end);
      });
  }

  /// The number of crossings in [enter, leave].
  int CountHits(const IsovalueLevel<T>& level, double enter, double leave) const
  {
    int count = 0;
    this->Walk(level, enter, leave, leave,
      [&](const GridWalk& cells, const T* corner, double in, double out)
      {
        double corners[8];
        Lanes start;
        Lanes end;
        if (this->EnterCell(level, cells, corner, in, out, corners, start, end))
        {
          count += CountCrossings(corners, start, end);
        }
        return false;
      });
    return count;
  }

private:
  /// Calls `intersect(cells, corner, enter, leave)` for the cells that the isovalue is in, until it
  /// says that there is a hit, and returns whether it did.
  template <class Intersect>
  bool Walk(const IsovalueLevel<T>& level, double enter, double leave, double limit,
    const Intersect& intersect) const
  {
    const std::ptrdiff_t row = this->Cells.GetBrick().GetRow();
    const std::ptrdiff_t slice = this->Cells.GetBrick().GetSlice();
    return this->Cells.VisitCells(
      enter, leave, limit,
      [&](const bricks::MacrocellRange<T>& range) { return level.Separates(range.Min, range.Max); },
      [&](const GridWalk& walk, const T* corner, double in, double out)
      {
        return CornerTest<T>::IsSeparated(corner, row, slice, level.GetFirst()) &&
          intersect(walk, corner, in, out);
      });
  }

  /// Returns whether the cell holds data. If it does, `corners` are its corner values minus the
  /// isovalue.
  bool GetCorners(
    const IsovalueLevel<T>& level, const T* corner, const Lanes& cell, double corners[8]) const
  {
    if (!this->Cells.IsCovered(cell))
    {
      return false;
    }
    const std::ptrdiff_t row = this->Cells.GetBrick().GetRow();
    const std::ptrdiff_t slice = this->Cells.GetBrick().GetSlice();
    double check = 0.0;
    for (int pair = 0; pair < 4; ++pair)
    {
      const T* from = corner + (pair & 1) * row + (pair >> 1) * slice;
      corners[2 * pair] = level.Subtract(from[0]);
      corners[2 * pair + 1] = level.Subtract(from[1]);
      // Becomes, and stays, not a number where one of them is not finite.
      check += (corners[2 * pair] + corners[2 * pair + 1]) * 0.0;
    }
    return std::is_integral_v<T> || check == 0.0;
  }

  /// Finds the corners, the start and the end in the cell with the given first corner, which the
  /// ray crosses from enter to leave. Returns false when the cell holds no data.
  bool EnterCell(const IsovalueLevel<T>& level, const GridWalk& cells, const T* corner,
    double enter, double leave, double corners[8], Lanes& start, Lanes& end) const
  {
    const Lanes cell = this->Cells.GetCell(cells);
    start = this->Cells.GetLocal(cell, enter);
    end = this->Cells.GetLocal(cell, leave);
    return this->GetCorners(level, corner, cell, corners);
  }

  /// The first hit in that cell.
  bool IntersectCell(const IsovalueLevel<T>& level, const GridWalk& cells, const T* corner,
    double enter, double leave, CellHit& hit) const
  {
    double corners[8];
    Lanes start;
    Lanes end;
    double s;
    if (!this->EnterCell(level, cells, corner, enter, leave, corners, start, end) ||
      !FindFirstCrossing(corners, start, end, s))
    {
      return false;
    }
    const Lanes cell = this->Cells.GetCell(cells);
    hit.T = std::min(enter + s * (leave - enter), leave);
    hit.FromInside = EvaluateTrilinear(corners, start) >= 0.0;
    hit.Local = Clamp(start + Lanes(s) * (end - start), Lanes(0.0), Lanes(1.0));
    for (int axis = 0; axis < 3; ++axis)
    {
      hit.Cell[axis] = static_cast<int>(cell[axis] - this->Cells.GetOrigin()[axis]);
    }
    return true;
  }

  BrickCells<T, Ray> Cells;
};

} // namespace rt

#endif
