// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TypedPacketBrick_h
#define rt_TypedPacketBrick_h

#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/lattice/NodeOrder.h"
#include "DSMRayTracing/field/lattice/PacketBrick.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace rt
{

/// A brick of samples of type T as rays see it that move `forward` or not on each axis. Remembers what
/// it has found in a part, since neighboring rays ask for the same. Keeps references; for one thread.
///
/// `RangeTest` says what rays look for; see IsovalueTest.
template <class T, class RangeTest>
class TypedPacketBrick final : public PacketBrick
{
public:
  TypedPacketBrick(const bricks::VoxelBrick<T>& brick, const RangeTest& test, const bool forward[3])
    : Brick(brick)
    , Test(test)
    , Order(forward)
  {
    if constexpr (std::is_same_v<T, float>)
    {
      if (brick.GetHeader().MaskOffset == 0)
      {
        this->Floats = { brick.GetSamples(), static_cast<double>(brick.GetRow()),
          static_cast<double>(brick.GetSlice()), test.GetSubtracted() };
      }
    }
  }

  int GetMacrocells(int axis) const override { return this->Brick.GetMacrocells(axis); }
  int GetCells(int axis) const override { return this->Brick.GetCells(axis); }

  bool HasCell(const int cell[3]) const override
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (cell[axis] < 0 || cell[axis] >= this->Brick.GetCells(axis))
      {
        return false;
      }
    }
    return this->Brick.HoldsData(cell[0], cell[1], cell[2]);
  }

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
    int counts[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      counts[axis] = std::min(bricks::MacrocellEdge, this->Brick.GetCells(axis) - first[axis]);
    }
    this->Part.Cells[macrocell] =
      this->Order.TurnAll(this->Test.FindCells(this->Brick, first, counts));
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
      return this->Test.FindMacrocells(
        ranges + 4 * (part[0] + row * part[1] + slice * part[2]), row, slice);
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
          found |= std::uint64_t{ this->Test.MayHold(row[x]) } << (x + 4 * y + 16 * z);
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
      const Lanes::Half two = this->Test.SubtractPair(from);
      corners[2 * pair * stride] = two[0];
      corners[(2 * pair + 1) * stride] = two[1];
      // Becomes, and stays, not a number where one of them is not finite.
      check += two * 0.0;
    }
    return std::is_integral_v<T> || check[0] + check[1] == 0.0;
  }

  const bricks::VoxelBrick<T>& Brick;
  const RangeTest& Test;
  NodeOrder Order;
  mutable PacketPart Part;
};

} // namespace rt

#endif
