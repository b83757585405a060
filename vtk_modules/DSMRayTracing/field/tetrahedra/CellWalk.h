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
#include <type_traits>
#include <utility>
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

  /// What is gathered of a tetrahedron.
  struct Part
  {
    double Enter;
    double Exit;
    double First;
    double Last;
    std::uint32_t Brick;
    std::uint16_t Corners[4];
  };
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
    const auto gather = [&](const auto& filter)
    {
      BrickCrossings(brick, numbers, ray, filter)
        .ForEach([&](const TetrahedronCrossing& crossing, const std::uint16_t* corners)
          { this->Add(crossing, ray.Triangles, number, corners); });
    };
    const bricks::CellValueHeader& header = numbers.GetHeader();
    if (HoldsAll(mayHold, { header.First, header.Last }))
    {
      gather(AnyFilter());
    }
    else
    {
      gather(PredicateFilter(header, mayHold));
    }
  }

  /// Returns whether a predicate that can tell holds everywhere in a range.
  template <class Predicate>
  static bool HoldsAll(const Predicate& mayHold, const bricks::ValueRange& range)
  {
    if constexpr (HasHoldsAll<Predicate>::value)
    {
      return mayHold.HoldsAll(range);
    }
    return false;
  }
  template <class Predicate, class = void>
  struct HasHoldsAll : std::false_type
  {
  };
  template <class Predicate>
  struct HasHoldsAll<Predicate,
    std::void_t<decltype(std::declval<const Predicate&>().HoldsAll(bricks::ValueRange()))>>
    : std::true_type
  {
  };

  /// Keeps the part of a crossing that is within the ray.
  void Add(const TetrahedronCrossing& crossing, const TriangleRay& ray, std::uint32_t brick,
    const std::uint16_t* corners) const
  {
    const double slope = crossing.Exit > crossing.Enter
      ? (crossing.Last - crossing.First) / (crossing.Exit - crossing.Enter)
      : 0.0;
    Part& part = this->Waiting.emplace_back();
    part.Enter = std::max(crossing.Enter, ray.Min);
    part.Exit = std::min(crossing.Exit, ray.Max);
    part.First = part.Enter == crossing.Enter
      ? crossing.First
      : crossing.First + slope * (part.Enter - crossing.Enter);
    part.Last = part.Exit == crossing.Exit ? crossing.Last
                                           : crossing.First + slope * (part.Exit - crossing.Enter);
    part.Brick = brick;
    std::copy_n(corners, 4, part.Corners);
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
    const auto isBefore = [](const Part& one, const Part& other)
    {
      return one.Enter != other.Enter
        ? one.Enter < other.Enter
        : std::tie(one.Exit, one.First, one.Last) < std::tie(other.Exit, other.First, other.Last);
    };
    const auto reached = std::partition(this->Waiting.begin(), this->Waiting.end(),
      [end](const Part& part) { return part.Enter >= end; });
    std::sort(reached, this->Waiting.end(), isBefore);
    const bool isFound = std::any_of(reached, this->Waiting.end(),
      [&](const Part& part)
      {
        const bricks::ValueRange range =
          RoundOut(std::min(part.First, part.Last), std::max(part.First, part.Last));
        return mayHold(range) && visit(GetSegment(part, range));
      });
    this->Waiting.erase(reached, this->Waiting.end());
    return isFound;
  }

  static Segment GetSegment(const Part& part, const bricks::ValueRange& range)
  {
    Segment segment;
    segment.Enter = part.Enter;
    segment.Exit = part.Exit;
    segment.Values = { { part.First, part.Last - part.First, 0.0, 0.0 } };
    segment.Last = part.Last;
    segment.Range = range;
    segment.At.Brick = part.Brick;
    std::copy_n(part.Corners, 4, segment.At.Corners);
    return segment;
  }

  Store& Blocks;
  typename Store::Worker& Self;
  // Storage that is kept from ray to ray.
  mutable std::vector<Entry> Entered;
  mutable std::vector<Part> Waiting;
};

} // namespace rt

#endif
