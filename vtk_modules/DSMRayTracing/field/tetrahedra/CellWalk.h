// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellWalk_h
#define rt_CellWalk_h

#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/base/ValueRange.h"
#include "DSMRayTracing/field/tetrahedra/CellCrossings.h"
#include "DSMRayTracing/field/tetrahedra/CellField.h"
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

  template <class Predicate>
  void Gather(const bricks::CellValues& values, std::uint32_t number, const ShearedRay& ray,
    const Predicate& mayHold) const
  {
    const auto pins =
      this->Blocks.AcquirePair(this->Self, *values.Cells->Segment, number, *values.Segment, number);
    const bricks::CellBrick brick(pins.first.GetData());
    const bricks::CellValueBrick numbers(pins.second.GetData());
    const PredicateFilter filter(numbers.GetHeader(), mayHold);
    BrickCrossings(brick, numbers, ray, filter)
      .ForEach([&](const TetrahedronCrossing& crossing, const std::uint16_t* corners)
        { this->Add(crossing, ray.Triangles, number, corners); });
  }

  /// Keeps the part of a crossing that is within the ray.
  void Add(const TetrahedronCrossing& crossing, const TriangleRay& ray, std::uint32_t brick,
    const std::uint16_t* corners) const
  {
    const double slope = crossing.Exit > crossing.Enter
      ? (crossing.Last - crossing.First) / (crossing.Exit - crossing.Enter)
      : 0.0;
    Segment& segment = this->Waiting.emplace_back();
    segment.Enter = std::max(crossing.Enter, ray.Min);
    segment.Exit = std::min(crossing.Exit, ray.Max);
    const double first = segment.Enter == crossing.Enter
      ? crossing.First
      : crossing.First + slope * (segment.Enter - crossing.Enter);
    segment.Last = segment.Exit == crossing.Exit
      ? crossing.Last
      : crossing.First + slope * (segment.Exit - crossing.Enter);
    segment.Values = { { first, segment.Last - first, 0.0, 0.0 } };
    segment.Range = RoundOut(std::min(first, segment.Last), std::max(first, segment.Last));
    segment.At.Brick = brick;
    std::copy_n(corners, 4, segment.At.Corners);
  }

  static bricks::ValueRange RoundOut(double least, double most)
  {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const auto first = static_cast<float>(least);
    const auto last = static_cast<float>(most);
    return { first > least ? std::nextafter(first, -infinity) : first,
      last < most ? std::nextafter(last, infinity) : last };
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
