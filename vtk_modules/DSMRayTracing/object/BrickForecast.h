// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BrickForecast_h
#define rt_BrickForecast_h

#include <cstddef>

namespace rt
{

/// How many bricks, from the front, a beam will go through, by what those around it did.
struct BrickForecast
{
  std::size_t Mean = 0;
  std::size_t Least = 0;
};

} // namespace rt

#endif
