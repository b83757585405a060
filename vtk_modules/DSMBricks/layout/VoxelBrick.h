// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_VoxelBrick_h
#define bricks_VoxelBrick_h

#include "DSMBricks/layout/VoxelBrickHeader.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace bricks
{

/// Smallest and largest sample of a macrocell's cells; Min > Max when none of them holds data.
template <class T>
struct MacrocellRange
{
  T Min;
  T Max;
};

/// The bytes of a voxel brick, read as samples of type T. A view: valid as long as the block is.
/// All coordinates are cells and points of the brick, from 0. See VoxelBrickHeader for the layout.
template <class T>
class VoxelBrick
{
public:
  explicit VoxelBrick(const std::byte* block)
    : Block(block)
    , Header(*reinterpret_cast<const VoxelBrickHeader*>(block))
    , Samples(reinterpret_cast<const T*>(block + this->Header.SampleOffset))
    , Row(this->Header.Cells[0] + 1)
    , Slice(this->Row * (this->Header.Cells[1] + 1))
  {
  }

  const VoxelBrickHeader& GetHeader() const { return this->Header; }
  int GetCells(int axis) const { return this->Header.Cells[axis]; }
  int GetMacrocells(int axis) const { return this->Header.Macrocells[axis]; }

  const MacrocellRange<T>* GetMacrocellRanges() const
  {
    return reinterpret_cast<const MacrocellRange<T>*>(
      this->Block + VoxelBrickHeader::MacrocellOffset);
  }

  const T* GetSamples() const { return this->Samples; }
  /// Samples from one point to the next on y, and on z; on x it is 1.
  int GetRow() const { return this->Row; }
  int GetSlice() const { return this->Slice; }
  int GetOffset(int x, int y, int z) const { return x + y * this->Row + z * this->Slice; }
  T GetSample(int x, int y, int z) const { return this->Samples[this->GetOffset(x, y, z)]; }

  /// Null: all cells may hold data.
  const std::uint8_t* GetMask() const
  {
    return this->Header.MaskOffset == 0
      ? nullptr
      : reinterpret_cast<const std::uint8_t*>(this->Block + this->Header.MaskOffset);
  }
  /// Returns whether the mask allows the cell to hold data; its corners may still not be finite.
  bool IsCovered(int x, int y, int z) const
  {
    const std::uint8_t* const mask = this->GetMask();
    if (!mask)
    {
      return true;
    }
    const int cell = x + this->GetCells(0) * (y + this->GetCells(1) * z);
    return (mask[cell >> 3] >> (cell & 7) & 1) != 0;
  }

  /// Returns whether the values at all corners of the cell are finite.
  bool HasFiniteCorners(int x, int y, int z) const
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      const T* corner = this->Samples + this->GetOffset(x, y, z);
      for (const int offset : { 0, this->Row, this->Slice, this->Row + this->Slice })
      {
        if (!std::isfinite(corner[offset]) || !std::isfinite(corner[offset + 1]))
        {
          return false;
        }
      }
    }
    return true;
  }

  /// Only such cells can hold a surface.
  bool HoldsData(int x, int y, int z) const
  {
    return this->IsCovered(x, y, z) && this->HasFiniteCorners(x, y, z);
  }

private:
  const std::byte* Block;
  const VoxelBrickHeader& Header;
  const T* Samples;
  int Row;
  int Slice;
};

} // namespace bricks

#endif
