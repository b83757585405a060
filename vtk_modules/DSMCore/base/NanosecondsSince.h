// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_NanosecondsSince_h
#define dsm_NanosecondsSince_h

#include <chrono>
#include <cstdint>

namespace dsm
{

inline std::uint64_t NanosecondsSince(std::chrono::steady_clock::time_point start)
{
  return static_cast<std::uint64_t>(
    std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start)
      .count());
}

} // namespace dsm

#endif
