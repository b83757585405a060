// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TransferTest_h
#define rt_TransferTest_h

#include "DSMBricks/layout/GridPlanes.h"
#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/MediumTolerance.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/lattice/MacrocellKernel.h"
#include "DSMRayTracing/field/lattice/NodeOrder.h"
#include "DSMRayTracing/field/lattice/PacketBrick.h"
#include "DSMRayTracing/look/TransferFunction.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace rt
{

/// Test of TypedPacketBrick for a medium; see IsovalueTest. Keeps a reference.
template <class T>
class TransferTest
{
public:
  /// `axes`: from index or grid space to the world. `planes`: of a rectilinear grid, or null; `origin`: the brick's
  /// first cell there.
  TransferTest(const TransferFunction& function, const MacrocellKernel& kernel,
    const glm::dmat3& axes, const bricks::GridPlanes* planes, const double origin[3])
    : Function(function)
    , Kernel(kernel)
    , Axes(axes)
    , Planes(planes)
    , Origin(origin)
    , CellLength(GetLongestWay(axes))
  {
  }

  std::uint64_t FindMacrocells(
    const bricks::MacrocellRange<T>* ranges, std::ptrdiff_t row, std::ptrdiff_t slice) const
  {
    return FindEachMacrocell(ranges, row, slice,
      [this](const bricks::MacrocellRange<T>& range) { return this->MayHold(range); });
  }
  bool MayHold(const bricks::MacrocellRange<T>& range) const
  {
    return range.Min <= range.Max &&
      this->Function.IsSeen(static_cast<double>(range.Min), static_cast<double>(range.Max));
  }

  /// All cells of the macrocell: what is seen in them is found out when they are crossed.
  std::uint64_t FindCells(const bricks::VoxelBrick<T>&, const int*, const int counts[3]) const
  {
    return GetNodeBox(counts);
  }

  /// Describes a macrocell of the part, and finds out whether the value along any ray in it is nearly quadratic.
  /// The trilinear values deviate from that by as much as from any smooth curve: by an eighth of how much they bend
  /// in a cell.
  void Describe(const bricks::VoxelBrick<T>& brick, const int first[3], const int counts[3],
    int macrocell, PacketPart& part) const
  {
    constexpr int edge = bricks::MacrocellEdge;
    const bricks::MacrocellRange<T>& range = brick.GetMacrocellRanges()[first[0] / edge +
      brick.GetMacrocells(0) * (first[1] / edge + brick.GetMacrocells(1) * (first[2] / edge))];
    const double scale = this->Function.GetScale();
    const auto getPlace = [&](T value)
    { return (static_cast<double>(value) - this->Function.GetFirst()) * scale; };
    const TransferFunction::Behavior behavior =
      this->Function.FindBehavior(getPlace(range.Min), getPlace(range.Max));
    part.Extinction[macrocell] = behavior.Extinction;
    part.Change[macrocell] = behavior.Change;
    part.Tinge[macrocell] = behavior.Tinge;
    if (brick.GetHeader().MaskOffset == 0)
    {
      MacrocellSamples samples;
      const bool isFinite = samples.Set(brick, first, counts);
      const double length =
        this->Planes ? this->SetWidths(samples, first, counts) : edge * this->CellLength;
      const double factor = length * behavior.Change * scale * 0.125;
      const bool isSmooth =
        isFinite && factor * this->Kernel.FindRoughness(samples) <= MediumTolerance::Depth;
      part.Smooth |= std::uint64_t{ isSmooth } << macrocell;
    }
  }

  double GetSubtracted() const { return this->Function.GetFirst(); }
  Lanes::Half SubtractPair(const T* samples) const
  {
    return Lanes::Half{ static_cast<double>(samples[0]), static_cast<double>(samples[1]) } -
      this->Function.GetFirst();
  }

private:
  /// Through a cell with such edges.
  static double GetLongestWay(const glm::dmat3& edges)
  {
    double longest = 0.0;
    for (const double y : { -1.0, 1.0 })
    {
      for (const double z : { -1.0, 1.0 })
      {
        longest = std::max(longest, glm::length(edges[0] + y * edges[1] + z * edges[2]));
      }
    }
    return longest;
  }

  /// Sets the widths of a rectilinear macrocell's samples; returns the longest way through it.
  double SetWidths(MacrocellSamples& samples, const int first[3], const int counts[3]) const
  {
    glm::dmat3 edges = this->Axes;
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto begin =
        static_cast<std::size_t>(this->Origin[axis]) + static_cast<std::size_t>(first[axis]);
      const double* const places = this->Planes->GetPlaces(axis) + begin;
      edges[axis] *= places[counts[axis]] - places[0];
      samples.SetWidths(axis, this->Planes->GetInverseWidths(axis) + begin);
    }
    return GetLongestWay(edges);
  }

  const TransferFunction& Function;
  const MacrocellKernel& Kernel;
  glm::dmat3 Axes;
  const bricks::GridPlanes* Planes;
  const double* Origin;
  double CellLength; ///< longest way through a cell of a uniform lattice, in world space
};

} // namespace rt

#endif
