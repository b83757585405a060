// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BrickCells_h
#define rt_BrickCells_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/field/grid/GridRay.h"
#include "DSMRayTracing/field/grid/GridWalk.h"
#include "DSMRayTracing/field/grid/MacrocellWalk.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace rt
{

/// The cells of one brick along a ray (GridRay or StretchedRay). Keeps references.
template <class T, class Ray = GridRay>
class BrickCells
{
public:
  /// `origin`: the brick's first cell.
  BrickCells(const Ray& ray, const bricks::VoxelBrick<T>& brick, const Lanes& origin)
    : Line(ray)
    , Brick(brick)
    , Origin(origin)
    , CellStrides(brick.GetRow(), brick.GetSlice())
  {
  }

  const Lanes& GetOrigin() const { return this->Origin; }
  const bricks::VoxelBrick<T>& GetBrick() const { return this->Brick; }

  /// Calls `visit(walk, corner, enter, leave)` for the cells of the macrocells whose range satisfies `mayHold`, from
  /// `enter` to `leave`, which differ and lie in the brick, or to `limit`, until it returns true; returns whether it
  /// did. `corner`: sample of the cell's first corner.
  template <class Predicate, class Visit>
  bool VisitCells(
    double enter, double leave, double limit, const Predicate& mayHold, const Visit& visit) const
  {
    return VisitMacrocells(this->Line, this->Brick, this->Origin, enter, leave, limit, mayHold,
      [&](const GridWalk& walk, double in, double out)
      { return this->VisitMacrocell(walk, in, out, visit); });
  }

  /// Returns the position of the ray in a cell at t, given its point there: exactly 0 or 1 where
  /// the ray meets a plane of the cell.
  Lanes GetLocal(const Lanes& cell, double t) const
  {
    const Lanes zero(0.0);
    const Lanes one(1.0);
    const Lanes inside = Clamp(this->Line.GetWithin(cell, t), zero, one);
    const Lanes lower = Select(this->Line.GetPlaneT(cell) == Lanes(t), zero, inside);
    return Select(this->Line.GetPlaneT(cell + one) == Lanes(t), one, lower);
  }

  /// Returns the first corner of the cell at which a walk is.
  Lanes GetCell(const GridWalk& walk) const { return walk.GetFirst(this->Line, 1.0); }

  /// Returns whether the mask allows the cell to hold data.
  bool IsCovered(const Lanes& cell) const
  {
    if (this->Brick.GetHeader().MaskOffset == 0)
    {
      return true;
    }
    const Lanes local = cell - this->Origin;
    return this->Brick.IsCovered(
      static_cast<int>(local[0]), static_cast<int>(local[1]), static_cast<int>(local[2]));
  }

private:
  /// The cells of the macrocell of `macrocells`, which the ray crosses from enter to leave.
  template <class Visit>
  bool VisitMacrocell(
    const GridWalk& macrocells, double enter, double leave, const Visit& visit) const
  {
    const Lanes first = macrocells.GetFirst(this->Line, bricks::MacrocellEdge);
    const Lanes size(
      this->Brick.GetCells(0), this->Brick.GetCells(1), this->Brick.GetCells(2), 1.0);
    const Lanes place = first - this->Origin;
    const Lanes counts = Min(size - place, Lanes(bricks::MacrocellEdge));
    GridWalk walk;
    const T* corner = this->Brick.GetSamples() +
      static_cast<std::int64_t>((place * this->CellStrides.Real).GetSum()) +
      walk.Start(this->Line, enter, NodeGrid{ first, 1.0, 1.0, counts, this->CellStrides });
    double t = enter;
    for (;;)
    {
      const double exit = std::min(walk.GetExit(), leave);
      if (visit(walk, corner, t, exit))
      {
        return true;
      }
      if (exit >= leave)
      {
        return false;
      }
      corner += walk.Advance(this->Line, exit);
      t = exit;
    }
  }

  const Ray& Line;
  const bricks::VoxelBrick<T>& Brick;
  Lanes Origin;
  NodeStrides CellStrides;
};

} // namespace rt

#endif
