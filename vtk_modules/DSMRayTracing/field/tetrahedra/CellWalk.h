// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellWalk_h
#define rt_CellWalk_h

#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/cells/CellBrick.h"
#include "DSMRayTracing/field/tetrahedra/CellField.h"
#include "DSMRayTracing/field/tetrahedra/SplitCells.h"
#include "DSMRayTracing/field/tetrahedra/TetrahedronCrossing.h"
#include "DSMRayTracing/field/walk/FieldSegment.h"
#include "DSMRayTracing/ray/ChildrenInRange.h"
#include "DSMRayTracing/ray/ChildrenOnRay.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/ShearedRay.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

namespace rt
{

/// The tetrahedra that a ray passes in a CellField, in order. What a brick has of the ray is gathered, whatever lies
/// between its cells, and sorted; it is visited when no brick is left that begins before it. So cells need no
/// neighbors, and the order does not depend on the bricks.
template <class Store>
class CellWalk
{
public:
  CellWalk(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
  {
  }

  template <class Predicate, class Visit>
  bool Find(
    const CellField& field, const Ray& ray, const Predicate& mayHold, const Visit& visit) const
  {
    const bricks::CellValues& values = *field.Voxels;
    ShearedRay there;
    if (!SetRay(field, ray, there))
    {
      return false;
    }
    this->Entered.clear();
    this->Waiting.clear();
    this->FindBricks(values, there, mayHold);
    for (const Entry& entry : this->Entered)
    {
      const double begin = there.StartT + entry.Enter / there.BoxesPerT;
      if (this->VisitUpTo(begin, mayHold, visit))
      {
        return true;
      }
      if (mayHold(values.Hierarchy.GetRange(entry.Brick)))
      {
        this->Gather(values, entry.Brick, there, mayHold);
      }
    }
    return this->VisitUpTo(std::numeric_limits<double>::infinity(), mayHold, visit);
  }

private:
  using Segment = FieldSegment<CellPlace>;

  struct Entry
  {
    float Enter;
    std::uint32_t Brick;
  };

  static bool SetRay(const CellField& field, const Ray& ray, ShearedRay& there)
  {
    const bricks::CellBricks& cells = *field.Voxels->Cells;
    const glm::dvec3 origin = field.ToIndex(ray.Origin);
    const glm::dvec3 direction = glm::dmat3(field.WorldToIndex) * ray.Direction;
    return !field.Voxels->Hierarchy.IsEmpty() &&
      there.Set(&origin.x, &direction.x, ray.Min, ray.Max, &cells.Lower.x, &cells.Upper.x);
  }

  /// The bricks on the ray, in the order in which it enters them.
  template <class Predicate>
  void FindBricks(
    const bricks::CellValues& values, const ShearedRay& ray, const Predicate& mayHold) const
  {
    const ChildrenInRange wanted(ChildrenOnRay(ray.Boxes, ray.BoxesEnd), mayHold);
    TraverseWideBvh(values.Hierarchy.GetNodes(), wanted,
      [&](std::uint32_t leaf, float enter) {
        this->Entered.push_back({ enter, bricks::RangedBrickBvh::GetBrick(leaf) });
      });
    std::sort(this->Entered.begin(), this->Entered.end(),
      [](const Entry& one, const Entry& other)
      { return std::tie(one.Enter, one.Brick) < std::tie(other.Enter, other.Brick); });
  }

  /// The children of a node of a brick that a ray meets and that may hold what is looked for.
  template <class Predicate>
  class Wanted
  {
  public:
    Wanted(const ShearedRay& ray, const bricks::CellBrick& brick,
      const bricks::CellValueBrick& values, const Predicate& mayHold)
      : Ray(ray)
      , Nodes(brick.GetNodes())
      , Values(values)
      , First(values.GetHeader().First)
      , Step(values.GetHeader().Step)
      , MayHold(mayHold)
    {
    }
    unsigned FindChildren(
      const bricks::CellBrick::Node& node, float enter[bricks::WideBvhWidth]) const
    {
      const unsigned met = this->Ray.Boxes.FindChildren(node, this->Ray.BoxesEnd, enter);
      const std::uint8_t* const ranges =
        this->Values.GetRanges(static_cast<std::uint32_t>(&node - this->Nodes));
      unsigned found = 0;
      for (unsigned left = met; left != 0; left &= left - 1)
      {
        const int child = __builtin_ctz(left);
        const bricks::ValueRange range{ this->First +
            this->Step * static_cast<float>(ranges[child]),
          this->First + this->Step * static_cast<float>(ranges[bricks::WideBvhWidth + child]) };
        const bool isAny = range.First <= range.Last;
        found |= static_cast<unsigned>(isAny && this->MayHold(range)) << child;
      }
      return found;
    }
    bool IsOpen(float) const { return true; }

  private:
    const ShearedRay& Ray;
    const bricks::CellBrick::Node* Nodes;
    const bricks::CellValueBrick& Values;
    float First;
    float Step;
    const Predicate& MayHold;
  };

  template <class Predicate>
  void Gather(const bricks::CellValues& values, std::uint32_t number, const ShearedRay& ray,
    const Predicate& mayHold) const
  {
    const auto pins =
      this->Blocks.AcquirePair(this->Self, *values.Cells->Segment, number, *values.Segment, number);
    const bricks::CellBrick brick(pins.first.GetData());
    const bricks::CellValueBrick numbers(pins.second.GetData());
    const Wanted wanted(ray, brick, numbers, mayHold);
    TraverseWideBvh(brick.GetNodes(), wanted,
      [&](std::uint16_t leaf, float)
      {
        std::uint16_t corners[bricks::CellBrick::GroupSize][bricks::CellBrick::MostCorners];
        const int cells = brick.ReadGroup(bricks::CellBrick::GetGroup(leaf), corners);
        for (int cell = 0; cell < cells; ++cell)
        {
          this->GatherCell(brick, numbers.GetValues(), corners[cell], number, ray, mayHold);
        }
      });
  }

  template <class Predicate>
  void GatherCell(const bricks::CellBrick& brick, const float* values, const std::uint16_t* cell,
    std::uint32_t number, const ShearedRay& ray, const Predicate& mayHold) const
  {
    const int corners = brick.GetHeader().Corners;
    bricks::ValueRange all = bricks::ValueRange::GetEmpty();
    for (int corner = 0; corner < corners; ++corner)
    {
      const float value = values[cell[corner]];
      all.Add({ value, value });
    }
    if (!HasValues(values, cell, corners) || !mayHold(all))
    {
      return;
    }
    SplitCell(brick, cell,
      [&](const std::uint16_t* points)
      {
        const float numbers[4] = { values[points[0]], values[points[1]], values[points[2]],
          values[points[3]] };
        const bricks::ValueRange range{ std::min(
                                          { numbers[0], numbers[1], numbers[2], numbers[3] }),
          std::max({ numbers[0], numbers[1], numbers[2], numbers[3] }) };
        if (!mayHold(range))
        {
          return;
        }
        SeenPoint seen[4];
        for (int corner = 0; corner < 4; ++corner)
        {
          seen[corner] = SeenPoint(ray.Triangles, brick.GetPoint(points[corner]), numbers[corner]);
        }
        TetrahedronCrossing crossing;
        if (crossing.Find(ray.Triangles, seen))
        {
          this->Add(crossing, ray.Triangles, range, number, points);
        }
      });
  }

  /// Keeps the part of a crossing that is within the ray.
  void Add(const TetrahedronCrossing& crossing, const TriangleRay& ray,
    const bricks::ValueRange& range, std::uint32_t brick, const std::uint16_t* points) const
  {
    if (crossing.Exit < ray.Min || crossing.Enter > ray.Max)
    {
      return;
    }
    const double slope = crossing.Exit > crossing.Enter
      ? (crossing.Last - crossing.First) / (crossing.Exit - crossing.Enter)
      : 0.0;
    Segment segment;
    segment.Enter = std::max(crossing.Enter, ray.Min);
    segment.Exit = std::min(crossing.Exit, ray.Max);
    const double first = segment.Enter == crossing.Enter
      ? crossing.First
      : crossing.First + slope * (segment.Enter - crossing.Enter);
    segment.Last = segment.Exit == crossing.Exit
      ? crossing.Last
      : crossing.First + slope * (segment.Exit - crossing.Enter);
    segment.Values = { { first, segment.Last - first, 0.0, 0.0 } };
    segment.Range = range;
    segment.At.Point = glm::dvec3(0.0);
    segment.At.Brick = brick;
    std::copy_n(points, 4, segment.At.Corners);
    this->Waiting.push_back(segment);
  }

  /// Visits the segments that begin before `end`, in order.
  template <class Predicate, class Visit>
  bool VisitUpTo(double end, const Predicate& mayHold, const Visit& visit) const
  {
    const auto isBefore = [](const Segment& one, const Segment& other)
    {
      return std::tie(one.Enter, one.Exit, one.Values.Coefficients[0], one.Last) <
        std::tie(other.Enter, other.Exit, other.Values.Coefficients[0], other.Last);
    };
    const auto reached = std::partition(this->Waiting.begin(), this->Waiting.end(),
      [end](const Segment& segment) { return segment.Enter >= end; });
    std::sort(reached, this->Waiting.end(), isBefore);
    const bool isFound = std::any_of(reached, this->Waiting.end(),
      [&](const Segment& segment) { return mayHold(segment.Range) && visit(segment); });
    this->Waiting.erase(reached, this->Waiting.end());
    return isFound;
  }

  Store& Blocks;
  typename Store::Worker& Self;
  // Storage that is kept from ray to ray.
  mutable std::vector<Entry> Entered;
  mutable std::vector<Segment> Waiting;
};

} // namespace rt

#endif
