// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/build/VoxelSource.h"

#include <algorithm>

namespace bricks
{

void VoxelSource::ReadCellMask(const Box& cells, std::uint8_t* out) const
{
  std::fill_n(out, cells.GetCount(), std::uint8_t{ 1 });
}

} // namespace bricks
