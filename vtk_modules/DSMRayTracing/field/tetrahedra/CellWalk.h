// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellWalk_h
#define rt_CellWalk_h

#include "DSMBricks/base/ValueRange.h"
#include "DSMRayTracing/field/tetrahedra/CellCrossings.h"
#include "DSMRayTracing/field/tetrahedra/CellField.h"
#include "DSMRayTracing/field/tetrahedra/CellKernel.h"
#include "DSMRayTracing/field/tetrahedra/CellPacket.h"
#include "DSMRayTracing/field/tetrahedra/SortedParts.h"
#include "DSMRayTracing/field/walk/FieldSegment.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

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

/// The tetrahedra that rays pass in a CellField, in order. The crossings of a packet with a brick are gathered,
/// whatever lies between its cells, and sorted; they are passed when no brick is left that begins before them. So
/// cells need no neighbors, and the order does not depend on the bricks.
template <class Store>
class CellWalk
{
public:
  CellWalk(
    Store& store, typename Store::Worker& worker, const CellKernel& kernel = CellKernel::GetBest())
    : Blocks(store)
    , Self(worker)
    , Kernel(kernel)
  {
  }

  /// See WalkSearch.
  template <class GetPredicate, class Visit>
  RayMask FindEach(const CellField& field, const Ray* rays, RayMask wanted,
    const GetPredicate& getPredicate, const Visit& visit) const
  {
    return this->PassEach(field, rays, wanted, getPredicate,
      [&](const CellPacket& packet, const CellKernel::Runs& runs, const auto& mayHold)
      {
        return FindRays(packet.GetLanes(),
          [&](int lane)
          {
            const Part* const first = runs.First[lane];
            return std::any_of(first, first + runs.Count[lane],
              [&](const Part& part)
              {
                const Segment segment = GetSegment(part);
                return mayHold(segment.Range) && visit(packet.Rays[lane], segment);
              });
          });
      });
  }

  /// Takes rays through the field in packets. Calls `pass(packet, runs, mayHold)` for the parts that they meet next; it
  /// returns the lanes that end there. `getPredicate`: as for FindEach. Returns the rays that have ended.
  template <class GetPredicate, class Pass>
  RayMask PassEach(const CellField& field, const Ray* rays, RayMask wanted,
    const GetPredicate& getPredicate, const Pass& pass) const
  {
    RayMask ended = 0;
    ForEachPacket(field, rays, wanted,
      [&](CellPacket& packet)
      {
        const RayMask all = packet.GetOpenRays();
        this->Walk(*field.Voxels, packet, getPredicate, pass);
        ended |= all & ~packet.GetOpenRays();
      });
    return ended;
  }

private:
  using Segment = FieldSegment<CellPlace>;
  using Part = CellKernel::Part;

  struct Entry
  {
    double Begin; ///< T: no ray of the packet enters before
    std::uint32_t Brick;
    RayMask Lanes;
  };

  template <class GetPredicate, class Pass>
  void Walk(const bricks::CellValues& values, CellPacket& packet, const GetPredicate& getPredicate,
    const Pass& pass) const
  {
    // A walk before may have ended by an exception.
    std::for_each(
      this->Waiting, this->Waiting + packet.Count, [](SortedParts& parts) { parts.Clear(); });
    this->FindBricks(values, packet, getPredicate(packet.GetOpenRays()));
    for (const Entry& entry : this->Entered)
    {
      const auto mayHold = getPredicate(packet.GetOpenRays());
      this->PassUpTo(entry.Begin, packet, mayHold, pass);
      if (mayHold(values.Hierarchy.GetRange(entry.Brick)))
      {
        this->Gather(values, entry, packet, mayHold);
      }
    }
    this->PassUpTo(
      std::numeric_limits<double>::infinity(), packet, getPredicate(packet.GetOpenRays()), pass);
  }

  /// The bricks on the rays, in the order in which the first of them enters.
  template <class Predicate>
  void FindBricks(
    const bricks::CellValues& values, const CellPacket& packet, const Predicate& mayHold) const
  {
    this->Entered.clear();
    ForEachBrick(this->Kernel, packet, values.Hierarchy, mayHold,
      [&](std::uint32_t brick, RayMask lanes, float enter)
      {
        double begin = std::numeric_limits<double>::infinity();
        ForEachRay(lanes,
          [&](int lane)
          { begin = std::min(begin, packet.StartT[lane] + enter / packet.BoxesPerT[lane]); });
        this->Entered.push_back({ begin, brick, lanes });
      });
    std::sort(this->Entered.begin(), this->Entered.end(),
      [](const Entry& one, const Entry& other)
      { return std::tie(one.Begin, one.Brick) < std::tie(other.Begin, other.Brick); });
  }

  template <class Predicate>
  void Gather(const bricks::CellValues& values, const Entry& entry, const CellPacket& packet,
    const Predicate& mayHold) const
  {
    if (this->Kernel.FindOpen(packet, entry.Lanes, 0.0f) == 0)
    {
      return;
    }
    const std::uint32_t number = entry.Brick;
    const auto pins =
      this->Blocks.AcquirePair(this->Self, *values.Cells->Segment, number, *values.Segment, number);
    const bricks::CellBrick brick(pins.first.GetData());
    const bricks::CellValueBrick numbers(pins.second.GetData());
    const auto gather = [&](const auto& filter)
    {
      BrickCrossings(this->Kernel, packet, brick, numbers, filter)
        .ForEach(entry.Lanes,
          [&](const CellKernel::Crossing& crossing, const std::uint16_t*)
          {
            const int lane = crossing.Lane;
            this->Waiting[lane].Insert(
              GetPart(crossing, packet.Lanes[lane].Min, packet.Lanes[lane].Max));
          });
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

  /// The part of a crossing that is within a ray.
  static Part GetPart(const CellKernel::Crossing& crossing, double min, double max)
  {
    Part part;
    part.Enter = std::max(crossing.Enter, min);
    part.Exit = std::min(crossing.Exit, max);
    part.First = crossing.First;
    part.Last = crossing.Last;
    if (part.Enter != crossing.Enter || part.Exit != crossing.Exit)
    {
      const double slope = crossing.Exit > crossing.Enter
        ? (crossing.Last - crossing.First) / (crossing.Exit - crossing.Enter)
        : 0.0;
      if (part.Enter != crossing.Enter)
      {
        part.First = crossing.First + slope * (part.Enter - crossing.Enter);
      }
      if (part.Exit != crossing.Exit)
      {
        part.Last = crossing.First + slope * (part.Exit - crossing.Enter);
      }
    }
    return part;
  }

  static bricks::ValueRange RoundOut(double least, double most)
  {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const auto first = static_cast<float>(least);
    const auto last = static_cast<float>(most);
    return { first > least ? std::nextafter(first, -infinity) : first,
      last < most ? std::nextafter(last, infinity) : last };
  }

  /// Passes the parts that begin before `end`.
  template <class Predicate, class Pass>
  void PassUpTo(double end, CellPacket& packet, const Predicate& mayHold, const Pass& pass) const
  {
    CellKernel::Runs runs;
    int most = 0;
    for (int lane = 0; lane < packet.Count; ++lane)
    {
      runs.First[lane] = this->Waiting[lane].GetFirst();
      runs.Count[lane] = this->Waiting[lane].CountBefore(end);
      most = std::max(most, runs.Count[lane]);
    }
    if (most == 0)
    {
      return;
    }
    const RayMask ended = pass(packet, runs, mayHold);
    for (int lane = 0; lane < packet.Count; ++lane)
    {
      this->Waiting[lane].Remove(runs.Count[lane]);
    }
    ForEachRay(ended,
      [&](int lane)
      {
        this->Waiting[lane].Clear();
        packet.End(lane);
      });
  }

  static Segment GetSegment(const Part& part)
  {
    Segment segment;
    segment.Enter = part.Enter;
    segment.Exit = part.Exit;
    segment.Values = { { part.First, part.Last - part.First, 0.0, 0.0 } };
    segment.Last = part.Last;
    segment.Range = RoundOut(std::min(part.First, part.Last), std::max(part.First, part.Last));
    segment.At.Brick = CellPlace::NoBrick;
    return segment;
  }

  Store& Blocks;
  typename Store::Worker& Self;
  const CellKernel& Kernel;
  // Storage that is kept from ray to ray.
  mutable std::vector<Entry> Entered;
  mutable SortedParts Waiting[MaxRays];
};

} // namespace rt

#endif
