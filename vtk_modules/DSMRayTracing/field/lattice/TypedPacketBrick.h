// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TypedPacketBrick_h
#define rt_TypedPacketBrick_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/lattice/IsovalueLevel.h"
#include "DSMRayTracing/field/lattice/MacrocellKernel.h"
#include "DSMRayTracing/field/lattice/NodeOrder.h"
#include "DSMRayTracing/field/lattice/PacketBrick.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace rt
{

/// A brick of samples of type T as rays see it that move `forward` or not on each axis. Remembers what
/// it has found in a part, since neighbouring rays ask for the same. Keeps references; for one thread.
template <class T>
class TypedPacketBrick final : public PacketBrick
{
public:
  TypedPacketBrick(const bricks::VoxelBrick<T>& brick, const IsovalueLevel<T>& level,
    const MacrocellComparison<T>& comparison, const bool forward[3])
    : Brick(brick)
    , Level(level)
    , Comparison(comparison)
    , Order(forward)
  {
    if constexpr (std::is_same_v<T, float>)
    {
      if (brick.GetHeader().MaskOffset == 0)
      {
        this->Floats = { brick.GetSamples(), static_cast<double>(brick.GetRow()),
          static_cast<double>(brick.GetSlice()), level.GetIsovalue() };
      }
    }
  }

  int GetMacrocells(int axis) const override { return this->Brick.GetMacrocells(axis); }

  const PacketPart& FindPart(const int part[3]) const override
  {
    this->Part.Macrocells = this->Order.TurnAll(this->ComparePart(part));
    this->Part.Known = 0;
    return this->Part;
  }

  void FindCells(const int part[3], int macrocell) const override
  {
    const int number = this->Order.Turn(macrocell);
    const int first[3] = { bricks::MacrocellEdge * (4 * part[0] + (number & 3)),
      bricks::MacrocellEdge * (4 * part[1] + (number >> 2 & 3)),
      bricks::MacrocellEdge * (4 * part[2] + (number >> 4)) };
    this->Part.Cells[macrocell] = this->Order.TurnAll(this->CompareCells(first));
    this->Part.Known |= std::uint64_t{ 1 } << macrocell;
  }

  unsigned GetCorners(unsigned rays, const double* cell, double* corners, int stride) const override
  {
    unsigned held = 0;
    for (; rays != 0; rays &= rays - 1)
    {
      const int ray = __builtin_ctz(rays);
      const int place[3] = { static_cast<int>(cell[ray]), static_cast<int>(cell[stride + ray]),
        static_cast<int>(cell[2 * stride + ray]) };
      if (this->GetCorners(place, corners + ray, stride))
      {
        held |= 1u << ray;
      }
    }
    return held;
  }

private:
  /// Bits from one row of samples to the next within a word.
  static constexpr int RowBits = 6;

  std::uint64_t ComparePart(const int part[3]) const
  {
    const bricks::MacrocellRange<T>* const ranges = this->Brick.GetMacrocellRanges();
    int last[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      last[axis] = std::min(4, this->Brick.GetMacrocells(axis) - 4 * part[axis]);
    }
    if (last[0] == 4 && last[1] == 4 && last[2] == 4)
    {
      const std::ptrdiff_t row = this->Brick.GetMacrocells(0);
      const std::ptrdiff_t slice = row * this->Brick.GetMacrocells(1);
      return this->Level.IsReachable()
        ? this->Comparison.FindMacrocells(ranges + 4 * (part[0] + row * part[1] + slice * part[2]),
            row, slice, this->Level.GetFirst())
        : 0;
    }
    std::uint64_t found = 0;
    for (int z = 0; z < last[2]; ++z)
    {
      for (int y = 0; y < last[1]; ++y)
      {
        const bricks::MacrocellRange<T>* const row = ranges + 4 * part[0] +
          this->Brick.GetMacrocells(0) *
            (4 * part[1] + y + this->Brick.GetMacrocells(1) * (4 * part[2] + z));
        for (int x = 0; x < last[0]; ++x)
        {
          found |= std::uint64_t{ this->Level.Separates(row[x].Min, row[x].Max) }
            << (x + 4 * y + 16 * z);
        }
      }
    }
    return found;
  }

  bool GetCorners(const int cell[3], double* corners, int stride) const
  {
    if (!this->Brick.IsCovered(cell[0], cell[1], cell[2]))
    {
      return false;
    }
    const T* first = this->Brick.GetSamples() + this->Brick.GetOffset(cell[0], cell[1], cell[2]);
    Lanes::Half check = {};
    for (int pair = 0; pair < 4; ++pair)
    {
      const T* from =
        first + (pair & 1) * this->Brick.GetRow() + (pair >> 1) * this->Brick.GetSlice();
      const Lanes::Half two = this->Level.SubtractPair(from);
      corners[2 * pair * stride] = two[0];
      corners[(2 * pair + 1) * stride] = two[1];
      // Becomes, and stays, not a number where one of them is not finite.
      check += two * 0.0;
    }
    return std::is_integral_v<T> || check[0] + check[1] == 0.0;
  }

  std::uint64_t CompareCells(const int first[3]) const
  {
    int counts[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      counts[axis] = std::min(bricks::MacrocellEdge, this->Brick.GetCells(axis) - first[axis]);
    }
    const int row = this->Brick.GetRow();
    if (*std::min_element(counts, counts + 3) == bricks::MacrocellEdge &&
      row >= MacrocellComparison<T>::RowSamples)
    {
      return this->Comparison.FindCells(
        this->Brick.GetSamples() + this->Brick.GetOffset(0, first[1], first[2]), first[0], row,
        this->Brick.GetSlice(), this->Level.GetFirst());
    }
    std::uint64_t cells = 0;
    Slice last = this->GetSlice(first, counts, 0);
    for (int z = 0; z < counts[2]; ++z)
    {
      const Slice next = this->GetSlice(first, counts, z + 1);
      const std::uint32_t mixed = (last.Any | next.Any) & ~(last.All & next.All);
      for (int y = 0; y < bricks::MacrocellEdge; ++y)
      {
        const std::uint64_t bits = mixed >> (RowBits * y) & 15u;
        cells |= bits << (4 * y + 16 * z);
      }
      last = next;
    }
    return cells & GetBox(counts);
  }

  /// Of the cells that have the samples of a slice as corners: whether some of those are inside,
  /// and whether all are.
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
  Slice GetSlice(const int first[3], const int counts[3], int z) const
  {
    std::uint32_t inside = 0;
    for (int y = 0; y <= counts[1]; ++y)
    {
      const T* row =
        this->Brick.GetSamples() + this->Brick.GetOffset(first[0], first[1] + y, first[2] + z);
      for (int x = 0; x <= counts[0]; ++x)
      {
        inside |= std::uint32_t{ this->Level.IsInside(row[x]) } << (x + RowBits * y);
      }
    }
    return GetSlice(inside);
  }

  /// The bits of the cells that there are.
  static std::uint64_t GetBox(const int counts[3])
  {
    std::uint64_t box = 0;
    for (int z = 0; z < counts[2]; ++z)
    {
      for (int y = 0; y < counts[1]; ++y)
      {
        box |= ((std::uint64_t{ 1 } << counts[0]) - 1) << (4 * y + 16 * z);
      }
    }
    return box;
  }

  const bricks::VoxelBrick<T>& Brick;
  const IsovalueLevel<T>& Level;
  const MacrocellComparison<T>& Comparison;
  NodeOrder Order;
  mutable PacketPart Part;
};

} // namespace rt

#endif
