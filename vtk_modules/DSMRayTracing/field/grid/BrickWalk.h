// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BrickWalk_h
#define rt_BrickWalk_h

#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMCore/base/Block.h"
#include "DSMRayTracing/field/grid/GridRay.h"
#include "DSMRayTracing/field/grid/GridWalk.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rt
{

/// Space leaping over the levels above the bricks: yields, front to back, the bricks on a ray that may hold what it
/// looks for. Walks each level within the macrocell of the one above, and enters only those macrocells that may.
/// `Predicate` decides that for a ValueRange; see IsovaluePredicate.
template <class Predicate, class Ray = GridRay>
class BrickWalk
{
public:
  /// The ray is followed from `enter` to `leave`, within the volume. All is kept by reference.
  BrickWalk(const bricks::MacrocellHierarchy& hierarchy, const Ray& ray, const Predicate& mayHold,
    double enter, double leave)
    : Levels(hierarchy.GetLevels())
    , Line(ray)
    , MayHold(mayHold)
    , Top(GetTop(this->Levels))
    , Level(this->Top)
  {
    const bricks::MacrocellHierarchy::Level& top = this->Levels[this->Top];
    this->StartLevel(Lanes(0.0), Lanes(top.Size[0], top.Size[1], top.Size[2], 1.0), enter, leave);
  }

  /// Goes on to the next brick; false when there is none left.
  bool Next()
  {
    for (;;)
    {
      Place& place = this->Places[this->Level];
      const bricks::ValueRange* ranges = this->Levels[this->Level].Ranges.data();
      // In local variables, which stay in registers.
      GridWalk walk = place.Walk;
      std::int64_t index = place.Index;
      double enter = place.T;
      const double leave = place.Leave;
      double exit = leave;
      while (enter < leave)
      {
        exit = std::min(walk.GetExit(), leave);
        if (this->MayHold(ranges[index]))
        {
          break;
        }
        index += walk.Advance(this->Line, exit);
        enter = exit;
      }
      if (!(enter < leave))
      {
        if (this->Level == this->Top)
        {
          return false;
        }
        ++this->Level;
        continue;
      }
      this->Origin = walk.GetFirst(this->Line, this->Levels[this->Level].Edge);
      place.Index = index + walk.Advance(this->Line, exit);
      place.Walk = walk;
      place.T = exit;
      if (this->Level == 0)
      {
        this->Id = static_cast<dsm::BlockId>(index);
        this->Enter = enter;
        this->Leave = exit;
        return true;
      }
      --this->Level;
      this->StartLevel(this->Origin, Lanes(1 << bricks::MacrocellHierarchy::Shift), enter, exit);
    }
  }

  dsm::BlockId GetId() const { return this->Id; }
  /// The brick's first cell.
  const Lanes& GetOrigin() const { return this->Origin; }
  double GetEnter() const { return this->Enter; }
  double GetLeave() const { return this->Leave; }

private:
  /// Enough for any volume: 2^31 bricks per axis.
  static constexpr int MaximalLevels = 17;
  /// In macrocells, along the longest axis.
  static constexpr int SmallestTop = 8;

  /// Position of the walk on one level.
  struct Place
  {
    GridWalk Walk;
    std::int64_t Index;
    double T;
    double Leave;
  };

  /// The top is where a ray begins: not at a level so coarse that it would be entered anyway.
  static int GetTop(const std::vector<bricks::MacrocellHierarchy::Level>& levels)
  {
    int top = static_cast<int>(levels.size()) - 1;
    while (top > 0 &&
      std::max({ levels[top].Size[0], levels[top].Size[1], levels[top].Size[2] }) < SmallestTop)
    {
      --top;
    }
    return top;
  }

  /// Starts in a box whose first cell is given, of up to `counts` macrocells of the level.
  void StartLevel(const Lanes& first, const Lanes& counts, double enter, double leave)
  {
    const bricks::MacrocellHierarchy::Level& level = this->Levels[this->Level];
    const Lanes size(level.Size[0], level.Size[1], level.Size[2], 1.0);
    const Lanes begin = Round(first * Lanes(level.InverseEdge));
    const NodeStrides strides(level.Size[0], std::int64_t{ level.Size[0] } * level.Size[1]);
    Place& place = this->Places[this->Level];
    place.Index = static_cast<std::int64_t>((begin * strides.Real).GetSum()) +
      place.Walk.Start(this->Line, enter,
        NodeGrid{ first, level.Edge, level.InverseEdge, Min(size - begin, counts), strides });
    place.T = enter;
    place.Leave = leave;
  }

  const std::vector<bricks::MacrocellHierarchy::Level>& Levels;
  const Ray& Line;
  const Predicate& MayHold;
  int Top;
  int Level;
  Place Places[MaximalLevels];
  dsm::BlockId Id = 0;
  Lanes Origin;
  double Enter = 0.0;
  double Leave = 0.0;
};

} // namespace rt

#endif
