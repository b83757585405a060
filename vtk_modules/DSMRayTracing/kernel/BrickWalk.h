// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BrickWalk_h
#define rt_BrickWalk_h

#include "DSMRayTracing/accel/MacrocellHierarchy.h"
#include "DSMRayTracing/brick/BrickLattice.h"
#include "DSMRayTracing/kernel/GridRay.h"

#include <vector>

namespace rt
{

/// Space leaping over the levels above the bricks: yields, front to back, the bricks on a ray that
/// may hold one of the isovalues, and skips the largest macrocells that hold none.
class BrickWalk
{
public:
  /// The ray is followed from `enter` to `leave`, within the volume.
  BrickWalk(const BrickLattice& lattice, const MacrocellHierarchy& hierarchy, const GridRay& ray,
    const std::vector<double>& isovalues, double enter, double leave)
    : Levels(hierarchy.GetLevels())
    , Line(ray)
    , Isovalues(isovalues)
    , Edge(lattice.GetEdge())
    , InverseEdge(1.0 / lattice.GetEdge())
    , Exit(enter)
    , Leave(leave)
  {
  }

  /// Goes on to the next brick; false when there is none left.
  bool Next()
  {
    while (this->Exit < this->Leave)
    {
      this->Enter = this->Exit;
      for (int axis = 0; axis < 3; ++axis)
      {
        this->Brick[axis] = this->Line.Locate(
          axis, this->Enter, 0, this->Edge, this->InverseEdge, this->Levels.front().Size[axis]);
      }
      const int empty = this->CountEmptyLevels();
      this->Exit = std::min(this->GetExit(empty > 0 ? empty - 1 : 0), this->Leave);
      if (empty == 0)
      {
        return true;
      }
    }
    return false;
  }

  const int* GetBrick() const { return this->Brick; }
  double GetEnter() const { return this->Enter; }
  double GetLeave() const { return this->Exit; }

private:
  bool MayHold(const ValueRange& range) const
  {
    for (const double isovalue : this->Isovalues)
    {
      if (range.MayHold(isovalue))
      {
        return true;
      }
    }
    return false;
  }

  /// How many levels, from the finest on, hold none of the isovalues at the brick.
  int CountEmptyLevels() const
  {
    int level = 0;
    for (const MacrocellHierarchy::Level& macrocells : this->Levels)
    {
      const int shift = level * MacrocellHierarchy::Shift;
      if (this->MayHold(macrocells.Get(
            this->Brick[0] >> shift, this->Brick[1] >> shift, this->Brick[2] >> shift)))
      {
        break;
      }
      ++level;
    }
    return level;
  }

  /// Where the ray leaves the macrocell of a level that the brick is in.
  double GetExit(int level) const
  {
    const int shift = level * MacrocellHierarchy::Shift;
    double exit = this->Leave;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::int64_t node = (this->Brick[axis] >> shift) + (this->Line.Step[axis] < 0 ? 0 : 1);
      const auto plane = static_cast<double>((node << shift) * this->Edge);
      exit = std::min(exit, this->Line.GetPlaneT(axis, plane));
    }
    return exit;
  }

  const std::vector<MacrocellHierarchy::Level>& Levels;
  const GridRay& Line;
  const std::vector<double>& Isovalues;
  int Edge;
  double InverseEdge;
  int Brick[3];
  double Enter = 0.0;
  double Exit;
  double Leave;
};

} // namespace rt

#endif
