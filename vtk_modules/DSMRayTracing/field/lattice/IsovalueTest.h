// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsovalueTest_h
#define rt_IsovalueTest_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/grid/IsovalueLevel.h"
#include "DSMRayTracing/field/lattice/MacrocellKernel.h"
#include "DSMRayTracing/field/lattice/NodeOrder.h"
#include "DSMRayTracing/field/lattice/PacketBrick.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace rt
{

/// Test of TypedPacketBrick for an isovalue. Bit x + 4 y + 16 z stands for a macrocell or a cell.
/// Keeps references.
template <class T>
class IsovalueTest
{
public:
  IsovalueTest(const IsovalueLevel<T>& level, const MacrocellComparison<T>& comparison)
    : Level(level)
    , Comparison(comparison)
  {
  }

  /// Returns those of 4 x 4 x 4 macrocells that may hold the surface; see MacrocellComparison.
  std::uint64_t FindMacrocells(
    const bricks::MacrocellRange<T>* ranges, std::ptrdiff_t row, std::ptrdiff_t slice) const
  {
    return this->Level.IsReachable()
      ? this->Comparison.FindMacrocells(ranges, row, slice, this->Level.GetFirst())
      : 0;
  }
  bool MayHold(const bricks::MacrocellRange<T>& range) const
  {
    return this->Level.Separates(range.Min, range.Max);
  }

  /// Returns the cells of a macrocell that have corners on both sides. The macrocell's first cell
  /// is `first`, and it has `counts` cells on each axis.
  std::uint64_t FindCells(
    const bricks::VoxelBrick<T>& brick, const int first[3], const int counts[3]) const
  {
    const int row = brick.GetRow();
    if (*std::min_element(counts, counts + 3) == bricks::MacrocellEdge &&
      row >= MacrocellComparison<T>::RowSamples)
    {
      return this->Comparison.FindCells(brick.GetSamples() + brick.GetOffset(0, first[1], first[2]),
        first[0], row, brick.GetSlice(), this->Level.GetFirst());
    }
    std::uint64_t cells = 0;
    Slice last = this->GetSlice(brick, first, counts, 0);
    for (int z = 0; z < counts[2]; ++z)
    {
      const Slice next = this->GetSlice(brick, first, counts, z + 1);
      const std::uint32_t mixed = (last.Any | next.Any) & ~(last.All & next.All);
      for (int y = 0; y < bricks::MacrocellEdge; ++y)
      {
        const std::uint64_t bits = mixed >> (RowBits * y) & 15u;
        cells |= bits << (4 * y + 16 * z);
      }
      last = next;
    }
    return cells & GetNodeBox(counts);
  }

  /// Returns the value that is subtracted from the corners.
  double GetSubtracted() const { return this->Level.GetIsovalue(); }
  Lanes::Half SubtractPair(const T* samples) const { return this->Level.SubtractPair(samples); }

private:
  /// Bits from one row of samples to the next within a word.
  static constexpr int RowBits = 6;

  /// Flags of cells that have samples of a slice as corners: whether any of these samples is
  /// inside, and whether all are.
  struct Slice
  {
    std::uint32_t Any;
    std::uint32_t All;
  };

  static Slice GetSlice(std::uint32_t inside)
  {
    const std::uint32_t any = inside | inside >> 1;
    const std::uint32_t all = inside & inside >> 1;
    return { any | any >> RowBits, all & all >> RowBits };
  }

  /// At the end of the brick, where there are fewer samples.
  Slice GetSlice(
    const bricks::VoxelBrick<T>& brick, const int first[3], const int counts[3], int z) const
  {
    std::uint32_t inside = 0;
    for (int y = 0; y <= counts[1]; ++y)
    {
      const T* row = brick.GetSamples() + brick.GetOffset(first[0], first[1] + y, first[2] + z);
      for (int x = 0; x <= counts[0]; ++x)
      {
        inside |= std::uint32_t{ this->Level.IsInside(row[x]) } << (x + RowBits * y);
      }
    }
    return GetSlice(inside);
  }

  const IsovalueLevel<T>& Level;
  const MacrocellComparison<T>& Comparison;
};

} // namespace rt

#endif
