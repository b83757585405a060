// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_CopyBox_h
#define vol_CopyBox_h

#include "DSMBricks/base/Box.h"

#include <algorithm>
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

/// Fills `bytes` with copies of one sample, or of several.
inline void Repeat(
  const std::byte* sample, std::size_t sampleBytes, std::byte* out, std::size_t bytes)
{
  // Each pass copies what is there already, as long as that stays in the processor's cache.
  constexpr std::size_t most = 1 << 14;
  std::size_t done = std::min(bytes, sampleBytes);
  std::memcpy(out, sample, done);
  for (std::size_t unit = done; done < bytes;)
  {
    const std::size_t more = std::min(unit, bytes - done);
    std::memcpy(out + done, out, more);
    done += more;
    unit = unit < most ? done : unit;
  }
}

} // namespace vol

#endif
