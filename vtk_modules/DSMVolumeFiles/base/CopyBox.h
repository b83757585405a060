// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_CopyBox_h
#define vol_CopyBox_h

#include "DSMBricks/base/Box.h"

#include <cstddef>
#include <cstring>

namespace vol
{

/// Copies the samples of `box` from a dense array of the samples of `fromBox` to one of those of `toBox`, x
/// fastest; both boxes contain it. A sample has so many bytes.
inline void CopyBox(const bricks::Box& box, const std::byte* from, const bricks::Box& fromBox,
  std::byte* to, const bricks::Box& toBox, std::size_t sampleBytes)
{
  const auto getOffset = [=](const bricks::Box& whole, std::int64_t y, std::int64_t z)
  {
    const bricks::Index3 size = whole.GetSize();
    const std::int64_t sample =
      ((z - whole.Min.z) * size.y + (y - whole.Min.y)) * size.x + (box.Min.x - whole.Min.x);
    return static_cast<std::size_t>(sample) * sampleBytes;
  };
  const std::size_t row = static_cast<std::size_t>(box.GetSize().x) * sampleBytes;
  for (std::int64_t z = box.Min.z; z < box.Max.z; ++z)
  {
    for (std::int64_t y = box.Min.y; y < box.Max.y; ++y)
    {
      std::memcpy(to + getOffset(toBox, y, z), from + getOffset(fromBox, y, z), row);
    }
  }
}

} // namespace vol

#endif
