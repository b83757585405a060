// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_SpaceOrder_h
#define vol_SpaceOrder_h

#include "DSMBricks/base/Box.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace vol
{

/// Which of x (0), y (1) and z (2) the axes of space in a file are, the slowest first.
using SpaceOrder = std::array<int, 3>;
constexpr SpaceOrder FastestX{ 2, 1, 0 };

/// Copies the first `size` samples along each axis of a dense array of `stored` samples in this order; `out`: dense, x
/// fastest.
inline void CopyOrdered(const std::byte* from, const bricks::Index3& stored,
  const SpaceOrder& order, std::byte* out, const bricks::Index3& size, std::size_t sampleBytes)
{
  bricks::Index3 stride;
  stride[order[2]] = 1;
  stride[order[1]] = stored[order[2]];
  stride[order[0]] = stored[order[2]] * stored[order[1]];
  for (std::int64_t z = 0; z < size.z; ++z)
  {
    for (std::int64_t y = 0; y < size.y; ++y)
    {
      for (std::int64_t x = 0; x < size.x; ++x, out += sampleBytes)
      {
        const auto place = static_cast<std::size_t>(x * stride.x + y * stride.y + z * stride.z);
        std::memcpy(out, from + place * sampleBytes, sampleBytes);
      }
    }
  }
}

} // namespace vol

#endif
