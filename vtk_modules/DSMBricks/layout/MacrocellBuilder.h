// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_MacrocellBuilder_h
#define bricks_MacrocellBuilder_h

#include "DSMBricks/layout/BrickBends.h"
#include "DSMBricks/layout/BrickLattice.h"
#include "DSMBricks/layout/LaneRanges.h"
#include "DSMBricks/layout/VoxelBrick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

namespace bricks
{

/// A float that is not above `value`, and hardly below it.
template <class T>
float RoundDown(T value)
{
  const auto wide = static_cast<double>(value);
  if (!(wide >= -static_cast<double>(std::numeric_limits<float>::max())))
  {
    return -std::numeric_limits<float>::infinity();
  }
  const auto largest = std::numeric_limits<float>::max();
  const float nearest = wide > static_cast<double>(largest) ? largest : static_cast<float>(wide);
  // The conversion of a 64-bit integer to double may have rounded up.
  const bool exact = std::is_floating_point_v<T> || std::abs(wide) < 9007199254740992.0;
  return exact && static_cast<double>(nearest) <= wide
    ? nearest
    : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

/// A float that is not below `value`, and hardly above it.
template <class T>
float RoundUp(T value)
{
  const auto wide = static_cast<double>(value);
  const auto largest = std::numeric_limits<float>::max();
  if (!(wide <= static_cast<double>(largest)))
  {
    return std::numeric_limits<float>::infinity();
  }
  const float nearest = wide < -static_cast<double>(largest) ? -largest : static_cast<float>(wide);
  const bool exact = std::is_floating_point_v<T> || std::abs(wide) < 9007199254740992.0;
  return exact && static_cast<double>(nearest) >= wide
    ? nearest
    : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

/// A range that no sample was added to.
template <class T>
constexpr MacrocellRange<T> EmptyRange{ std::numeric_limits<T>::max(),
  std::numeric_limits<T>::lowest() };

/// A box of cells of a brick.
struct CellBox
{
  int First[3];
  int Last[3]; ///< not of the box
};

/// The range of the corners of those cells of a box that hold data.
template <class T>
MacrocellRange<T> FindCellRange(const VoxelBrick<T>& brick, const CellBox& box)
{
  MacrocellRange<T> range = EmptyRange<T>;
  for (int z = box.First[2]; z < box.Last[2]; ++z)
  {
    for (int y = box.First[1]; y < box.Last[1]; ++y)
    {
      for (int x = box.First[0]; x < box.Last[0]; ++x)
      {
        if (!brick.HoldsData(x, y, z))
        {
          continue;
        }
        const T* corner = brick.GetSamples() + brick.GetOffset(x, y, z);
        for (const int offset :
          { 0, brick.GetRow(), brick.GetSlice(), brick.GetRow() + brick.GetSlice() })
        {
          range.Min = std::min({ range.Min, corner[offset], corner[offset + 1] });
          range.Max = std::max({ range.Max, corner[offset], corner[offset + 1] });
        }
      }
    }
  }
  return range;
}

/// Ranges of the samples of a row of macrocells over y and z, for each x. Many x are computed at a
/// time.
template <class T>
class RowOfRanges
{
public:
  /// `row`: as wide as the brick.
  void Find(const VoxelBrick<T>& brick, const CellBox& row)
  {
    const int points = row.Last[0] + 1;
    std::fill_n(this->Min.begin(), points, EmptyRange<T>.Min);
    std::fill_n(this->Max.begin(), points, EmptyRange<T>.Max);
    std::fill_n(this->Check.begin(), points, T{ 0 });
    for (int z = row.First[2]; z <= row.Last[2]; ++z)
    {
      for (int y = row.First[1]; y <= row.Last[1]; ++y)
      {
        AddToLanes(brick.GetSamples() + brick.GetOffset(0, y, z), points, this->Min.data(),
          this->Max.data(), this->Check.data());
      }
    }
  }

  /// From one x to another. Returns false when a sample is not finite.
  bool Get(int first, int last, MacrocellRange<T>& range) const
  {
    range = EmptyRange<T>;
    T check{ 0 };
    for (int x = first; x <= last; ++x)
    {
      range.Min = std::min(range.Min, this->Min[x]);
      range.Max = std::max(range.Max, this->Max[x]);
      check += this->Check[x];
    }
    return check == T{ 0 };
  }

private:
  static constexpr int Points = BrickLattice::LargestEdge + 1;

  std::array<T, Points> Min;
  std::array<T, Points> Max;
  std::array<T, Points> Check;
};

/// Derives, out of the samples and the mask of a brick, its macrocells, its own range and its bends.
template <class T>
void BuildMacrocells(std::byte* block)
{
  auto& header = *reinterpret_cast<VoxelBrickHeader*>(block);
  auto* ranges = reinterpret_cast<MacrocellRange<T>*>(block + VoxelBrickHeader::MacrocellOffset);
  const VoxelBrick<T> brick(block);
  const bool isWhole = header.MaskOffset == 0;
  header.First = std::numeric_limits<float>::infinity();
  header.Last = -std::numeric_limits<float>::infinity();
  RowOfRanges<T> row;
  CellBox box;
  for (box.First[2] = 0; box.First[2] < brick.GetCells(2); box.First[2] += MacrocellEdge)
  {
    box.Last[2] = std::min(box.First[2] + MacrocellEdge, brick.GetCells(2));
    for (box.First[1] = 0; box.First[1] < brick.GetCells(1); box.First[1] += MacrocellEdge)
    {
      box.Last[1] = std::min(box.First[1] + MacrocellEdge, brick.GetCells(1));
      if (isWhole)
      {
        box.First[0] = 0;
        box.Last[0] = brick.GetCells(0);
        row.Find(brick, box);
      }
      for (box.First[0] = 0; box.First[0] < brick.GetCells(0); box.First[0] += MacrocellEdge)
      {
        box.Last[0] = std::min(box.First[0] + MacrocellEdge, brick.GetCells(0));
        MacrocellRange<T> range;
        if (!isWhole || !row.Get(box.First[0], box.Last[0], range))
        {
          range = FindCellRange(brick, box);
        }
        *ranges++ = range;
        if (range.Min <= range.Max)
        {
          header.First = std::min(header.First, RoundDown(range.Min));
          header.Last = std::max(header.Last, RoundUp(range.Max));
        }
      }
    }
  }
  BuildBends<T>(block);
}

} // namespace bricks

#endif
