// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellCrossings_h
#define rt_CellCrossings_h

#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/cells/CellBrick.h"
#include "DSMRayTracing/field/tetrahedra/CellKernel.h"
#include "DSMRayTracing/field/tetrahedra/CellPacket.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rt
{

/// TraverseWideBvh for `lanes` of a packet: a node is visited once for all that meet its box before they end. Calls
/// `visit(reference, lanes, enter)` for leaves, about front to back; `enter`: where the first of the lanes does. It may
/// shorten rays of the packet. `findWanted(node)`: the children that may have what is looked for (bits).
template <class Node, class FindWanted, class Visit>
inline void TraverseTogether(const CellKernel& kernel, const CellPacket& packet, RayMask lanes,
  const Node* nodes, const FindWanted& findWanted, const Visit& visit)
{
  using Reference = typename Node::ReferenceType;
  struct Entry
  {
    float Enter;
    Reference Child;
    RayMask Lanes;
  };
  Entry stack[LargestWideBvhStack];
  stack[0] = { 0.0f, 0, lanes };
  int size = 1;
  while (size > 0)
  {
    Entry entry = stack[--size];
    entry.Lanes = kernel.FindOpen(packet, entry.Lanes, entry.Enter);
    if (entry.Lanes == 0)
    {
      continue;
    }
    if (entry.Child & Node::LeafBit)
    {
      visit(entry.Child, entry.Lanes, entry.Enter);
      continue;
    }
    const Node& node = nodes[entry.Child];
    unsigned wanted = findWanted(node) & ((1u << node.Children) - 1u);
    if (wanted == 0)
    {
      continue;
    }
    CellKernel::Children met;
    kernel.FindChildren(
      packet, entry.Lanes, { node.Origin, node.Exponent, node.Bounds }, wanted, met);
    const int bottom = size;
    for (; wanted != 0; wanted &= wanted - 1)
    {
      const int child = __builtin_ctz(wanted);
      if (met.Lanes[child] == 0)
      {
        continue;
      }
      int top = size++;
      for (; top > bottom && stack[top - 1].Enter < met.Enter[child]; --top)
      {
        stack[top] = stack[top - 1];
      }
      stack[top] = { met.Enter[child], node.References[child], met.Lanes[child] };
    }
  }
}

/// Visits the bricks of a field that a packet meets and whose range of values `mayHold`: as TraverseTogether, with
/// their numbers.
template <class Predicate, class Visit>
inline void ForEachBrick(const CellKernel& kernel, const CellPacket& packet,
  const bricks::RangedBrickBvh& hierarchy, const Predicate& mayHold, const Visit& visit)
{
  TraverseTogether(
    kernel, packet, packet.GetLanes(), hierarchy.GetNodes(),
    [&](const bricks::RangedBrickBvh::Node& node)
    {
      unsigned wanted = 0;
      for (int child = 0; child < node.Children; ++child)
      {
        wanted |= static_cast<unsigned>(mayHold(node.Ranges[child])) << child;
      }
      return wanted;
    },
    [&](std::uint32_t leaf, RayMask lanes, float enter)
    { visit(bricks::RangedBrickBvh::GetBrick(leaf), lanes, enter); });
}

/// Finds the tetrahedra of a brick that the rays of a packet cross.
template <class Filter>
class BrickCrossings
{
public:
  using Crossing = CellKernel::Crossing;

  /// `filter` selects values:
  /// - `FindChildren(ranges)`: bit i set when child i may have such, by the node's ranges (CellValueBrick);
  /// - `MayHold(first, last)`: whether values between these may be such;
  /// - `HoldsAny`: whether all values are such.
  /// All is kept by reference.
  BrickCrossings(const CellKernel& kernel, const CellPacket& packet, const bricks::CellBrick& brick,
    const bricks::CellValueBrick& values, const Filter& filter)
    : Kernel(kernel)
    , Packet(packet)
    , Brick(brick)
    , Values(values)
    , Numbers(values.GetValues())
    , Wanted(filter)
  {
  }

  /// Calls `visit(crossing, corners)` for the crossings of the rays of `lanes` between their Min and Max, nearer cells
  /// first, but in no strict order. `corners`: numbers of the tetrahedron's points. It may shorten rays.
  template <class Visit>
  void ForEach(RayMask lanes, const Visit& visit) const
  {
    const bricks::CellBrick::Node* const nodes = this->Brick.GetNodes();
    TraverseTogether(
      this->Kernel, this->Packet, lanes, nodes,
      [&](const bricks::CellBrick::Node& node)
      {
        const auto number = static_cast<std::uint32_t>(&node - nodes);
        return this->Wanted.FindChildren(this->Values.GetRanges(number));
      },
      [&](std::uint16_t leaf, RayMask met, float)
      {
        bricks::CellGroup cells;
        this->Brick.ReadGroup(bricks::CellBrick::GetGroup(leaf), cells);
        this->VisitGroup(cells, met, visit);
      });
  }

private:
  template <class Visit>
  void VisitGroup(const bricks::CellGroup& cells, RayMask lanes, const Visit& visit) const
  {
    CellKernel::Group group;
    if (!this->Read(cells, group))
    {
      return;
    }
    CellKernel::Crossing crossings[CellKernel::MostCrossings];
    const int count = this->Kernel.FindCrossings(this->Packet, lanes, group, crossings);
    for (int number = 0; number < count; ++number)
    {
      const Crossing& crossing = crossings[number];
      const std::uint8_t* const at = group.Tetrahedra[crossing.Part];
      const std::uint16_t points[4] = { cells.Numbers[at[0]], cells.Numbers[at[1]],
        cells.Numbers[at[2]], cells.Numbers[at[3]] };
      visit(crossing, points);
    }
  }

  /// False where the cells have nothing that is looked for.
  bool Read(const bricks::CellGroup& cells, CellKernel::Group& group) const
  {
    float values[bricks::CellGroup::MostPoints];
    bool isWhole = true;
    for (int point = 0; point < cells.Points; ++point)
    {
      values[point] = this->Numbers[cells.Numbers[point]];
      isWhole = isWhole && !std::isnan(values[point]);
    }
    group.Corners = cells.Corners;
    int parts = 0;
    for (int cell = 0; cell < cells.Cells; ++cell)
    {
      const std::uint8_t* const corners = cells.At[cell];
      if (!this->MayHold(values, corners, cells.Corners) ||
        !(isWhole || this->Values.HasValues(cells, cell)))
      {
        continue;
      }
      CellKernel::Group::Cell& read = group.Cells[group.CellCount];
      read.FirstPart = static_cast<std::uint8_t>(parts);
      this->ReadParts(cells, cell, values, group, parts);
      read.Parts = static_cast<std::uint8_t>(parts - read.FirstPart);
      if (read.Parts > 0)
      {
        std::copy_n(corners, bricks::CellGroup::MostCorners, read.At);
        std::for_each(corners, corners + cells.Corners,
          [&](std::uint8_t corner) { group.Used |= std::uint64_t(1) << corner; });
        ++group.CellCount;
      }
    }
    if (group.CellCount == 0)
    {
      return false;
    }
    const bricks::PackedPlaces places = this->Brick.GetPlaces();
    for (std::uint64_t used = group.Used; used != 0; used &= used - 1)
    {
      const int number = __builtin_ctzll(used);
      float place[3];
      places.Get(cells.Numbers[number], place);
      CellKernel::Group::Point& point = group.Points[number];
      for (int axis = 0; axis < 3; ++axis)
      {
        point.Place[axis] = place[this->Packet.Axes[axis]];
      }
      point.Value = values[number];
    }
    return true;
  }

  /// Adds those of a cell's tetrahedra that may have what is looked for, and are not flat.
  void ReadParts(const bricks::CellGroup& cells, int cell, const float* values,
    CellKernel::Group& group, int& parts) const
  {
    const std::uint8_t* const corners = cells.At[cell];
    const auto* const split = cells.GetParts(cell);
    for (int part = 0; part < cells.CountParts(); ++part)
    {
      std::uint8_t* const at = group.Tetrahedra[parts];
      for (int corner = 0; corner < 4; ++corner)
      {
        at[corner] = corners[split[part][corner]];
      }
      const bool isFlat = at[0] == at[1] || at[0] == at[2] || at[0] == at[3] || at[1] == at[2] ||
        at[1] == at[3] || at[2] == at[3];
      parts += static_cast<int>(!isFlat && this->MayHold(values, at, 4));
    }
  }

  bool MayHold(const float* values, const std::uint8_t* corners, int count) const
  {
    if constexpr (Filter::HoldsAny)
    {
      return true;
    }
    float least = values[corners[0]];
    float most = least;
    for (int corner = 1; corner < count; ++corner)
    {
      least = std::min(values[corners[corner]], least);
      most = std::max(values[corners[corner]], most);
    }
    return this->Wanted.MayHold(least, most);
  }

  const CellKernel& Kernel;
  const CellPacket& Packet;
  const bricks::CellBrick& Brick;
  const bricks::CellValueBrick& Values;
  const float* Numbers;
  const Filter& Wanted;
};

/// Looks by a predicate for ranges of values (ValuePredicates.h), which is kept by reference.
template <class Predicate>
class PredicateFilter
{
public:
  static constexpr bool HoldsAny = false;

  PredicateFilter(const bricks::CellValueHeader& header, const Predicate& mayHold)
    : First(header.First)
    , Step(header.Step)
    , Predicates(mayHold)
  {
  }

  unsigned FindChildren(const std::uint8_t* ranges) const
  {
    unsigned found = 0;
    for (int child = 0; child < bricks::WideBvhWidth; ++child)
    {
      const std::uint8_t low = ranges[child];
      const std::uint8_t high = ranges[bricks::WideBvhWidth + child];
      found |=
        static_cast<unsigned>(low <= high &&
          this->Predicates(bricks::ValueRange{ this->First + this->Step * static_cast<float>(low),
            this->First + this->Step * static_cast<float>(high) }))
        << child;
    }
    return found;
  }
  bool MayHold(float first, float last) const
  {
    return this->Predicates(bricks::ValueRange{ first, last });
  }

private:
  float First;
  float Step;
  const Predicate& Predicates;
};

/// Looks for any value.
class AnyFilter
{
public:
  static constexpr bool HoldsAny = true;

  static unsigned FindChildren(const std::uint8_t* ranges)
  {
    unsigned found = 0;
    for (int child = 0; child < bricks::WideBvhWidth; ++child)
    {
      found |= static_cast<unsigned>(ranges[child] <= ranges[bricks::WideBvhWidth + child])
        << child;
    }
    return found;
  }
  static bool MayHold(float, float) { return true; }
};

} // namespace rt

#endif
