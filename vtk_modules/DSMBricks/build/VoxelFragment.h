// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_VoxelFragment_h
#define bricks_VoxelFragment_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ScalarType.h"

#include <cstddef>
#include <cstdint>

namespace bricks
{

/// Header of a fragment of a voxel brick: the cells that it covers, in brick indices. The samples
/// at their corners follow, or those of the cells themselves if `OfCells`, x fastest; then, if
/// `HasMask`, one byte for each cell, 1 where it holds data.
struct VoxelFragmentHeader
{
  std::int32_t Min[3];
  std::int32_t Max[3];
  std::int32_t HasMask;
  std::int32_t OfCells;

  Box GetCells() const
  {
    return { Index3(this->Min[0], this->Min[1], this->Min[2]),
      Index3(this->Max[0], this->Max[1], this->Max[2]) };
  }
  /// Returns the positions of the samples, as points of the brick.
  Box GetSamples() const
  {
    const Box cells = this->GetCells();
    return { cells.Min, cells.Max + Index3(this->OfCells != 0 ? 0 : 1) };
  }
  std::size_t GetSampleBytes(ScalarType type) const
  {
    return static_cast<std::size_t>(this->GetSamples().GetCount()) * bricks::GetBytes(type);
  }
  std::size_t GetMaskBytes() const
  {
    return this->HasMask != 0 ? static_cast<std::size_t>(this->GetCells().GetCount()) : 0;
  }
};

} // namespace bricks

#endif
