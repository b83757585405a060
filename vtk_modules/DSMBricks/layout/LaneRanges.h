// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_LaneRanges_h
#define bricks_LaneRanges_h

#include <algorithm>
#include <type_traits>

namespace bricks
{

/// Adds a sample to each of so many ranges; compilers make vectors of it. `check` is 0 where none was added, and of
/// what is not finite it becomes, and stays, not a number.
template <class T>
void AddToLanes(const T* samples, int count, T* least, T* greatest, T* check)
{
  for (int lane = 0; lane < count; ++lane)
  {
    // GCC vectorizes the loop for values, but not for references to them.
    const T sample = samples[lane];
    const T low = least[lane];
    const T high = greatest[lane];
    least[lane] = std::min(low, sample);
    greatest[lane] = std::max(high, sample);
    if constexpr (std::is_floating_point_v<T>)
    {
      check[lane] += sample * T{ 0 };
    }
  }
}

} // namespace bricks

#endif
