// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellCrossings_h
#define rt_CellCrossings_h

#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/cells/CellBrick.h"
#include "DSMRayTracing/field/tetrahedra/CellKernel.h"
#include "DSMRayTracing/field/tetrahedra/CellPacket.h"
#include "DSMRayTracing/field/tetrahedra/SplitCells.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

#include <algorithm>
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
  /// - `MayHold(first, last)`: whether values between these may be such.
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
        std::uint16_t corners[bricks::CellBrick::GroupSize][bricks::CellBrick::MostCorners];
        const int cells = this->Brick.ReadGroup(bricks::CellBrick::GetGroup(leaf), corners);
        for (int cell = 0; cell < cells; ++cell)
        {
          this->VisitCell(corners[cell], met, visit);
        }
      });
  }

private:
  template <class Visit>
  void VisitCell(const std::uint16_t* corners, RayMask lanes, const Visit& visit) const
  {
    CellKernel::Cell cell;
    if (!this->Read(corners, cell))
    {
      return;
    }
    Crossing crossings[CellKernel::MostCrossings];
    const int count = this->Kernel.FindCrossings(this->Packet, lanes, cell, crossings);
    for (int number = 0; number < count; ++number)
    {
      const Crossing& crossing = crossings[number];
      const std::uint8_t* const at = cell.Tetrahedra[crossing.Part];
      const std::uint16_t points[4] = { corners[at[0]], corners[at[1]], corners[at[2]],
        corners[at[3]] };
      visit(crossing, points);
    }
  }

  /// False where the cell has nothing that is looked for.
  bool Read(const std::uint16_t* corners, CellKernel::Cell& cell) const
  {
    cell.Corners = this->Brick.GetHeader().Corners;
    float least = this->Numbers[corners[0]];
    float most = least;
    for (int corner = 0; corner < cell.Corners; ++corner)
    {
      const float value = this->Numbers[corners[corner]];
      cell.Values[corner] = value;
      least = std::min(value, least);
      most = std::max(value, most);
    }
    if (!this->Wanted.MayHold(least, most) || !HasValues(this->Numbers, corners, cell.Corners))
    {
      return false;
    }
    for (int corner = 0; corner < cell.Corners; ++corner)
    {
      const float* const point = this->Brick.GetPoint(corners[corner]);
      for (int place = 0; place < 3; ++place)
      {
        cell.Points[place][corner] = point[this->Packet.Axes[place]];
      }
    }
    std::uint8_t all[bricks::MostTetrahedra][4];
    const int parts = SplitCell(this->Brick, corners, all);
    cell.Parts = 0;
    for (int part = 0; part < parts; ++part)
    {
      if (this->MayHold(cell.Values, all[part]))
      {
        std::copy_n(all[part], 4, cell.Tetrahedra[cell.Parts++]);
      }
    }
    return cell.Parts > 0;
  }

  bool MayHold(const float* values, const std::uint8_t* corners) const
  {
    const float a = values[corners[0]];
    const float b = values[corners[1]];
    const float c = values[corners[2]];
    const float d = values[corners[3]];
    return this->Wanted.MayHold(
      std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d)));
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
