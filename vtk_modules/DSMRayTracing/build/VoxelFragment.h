// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VoxelFragment_h
#define rt_VoxelFragment_h

#include "DSMRayTracing/base/Box.h"
#include "DSMRayTracing/base/ScalarType.h"

#include <cstddef>
#include <cstdint>

namespace rt
{

/// What a fragment of a voxel brick begins with: the cells that it covers, in the brick. The samples
/// at their corners follow, x fastest; then, if `HasMask`, one byte a cell, 1 where it holds data.
struct VoxelFragmentHeader
{
  std::int32_t Min[3];
  std::int32_t Max[3];
  std::int32_t HasMask;
  std::int32_t Unused;

  Box GetCells() const
  {
    return { Index3(this->Min[0], this->Min[1], this->Min[2]),
      Index3(this->Max[0], this->Max[1], this->Max[2]) };
  }
  std::size_t GetSampleBytes(ScalarType type) const
  {
    const Box cells = this->GetCells();
    return static_cast<std::size_t>(Box{ cells.Min, cells.Max + Index3(1) }.GetCount()) *
      rt::GetBytes(type);
  }
  std::size_t GetMaskBytes() const
  {
    return this->HasMask != 0 ? static_cast<std::size_t>(this->GetCells().GetCount()) : 0;
  }
};

} // namespace rt

#endif
