// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CornerOrder_h
#define bricks_CornerOrder_h

#include <cstdint>
#include <cstring>

namespace bricks
{

/// Numbers the corners of a cell by their places in the space of the bricks (x first, then y, then z): the number of a
/// corner is the count of corners before it, and equal places have equal numbers. Every cell and every rank orders the
/// corners of a face alike. Places are finite, and their zeros are positive (PlaceInBrick).
template <int Count>
inline void OrderCorners(const float places[][3], std::uint8_t numbers[Count])
{
  // Integers in the order of the floats.
  const auto toInteger = [](float value)
  {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    return bits ^ ((bits >> 31) != 0 ? 0xffffffffu : 0x80000000u);
  };
  std::uint64_t xy[Count];
  std::uint32_t z[Count];
  for (int corner = 0; corner < Count; ++corner)
  {
    const float* const place = places[corner];
    xy[corner] = std::uint64_t(toInteger(place[0])) << 32 | toInteger(place[1]);
    z[corner] = toInteger(place[2]);
    numbers[corner] = 0;
  }
  for (int one = 0; one < Count; ++one)
  {
    for (int other = one + 1; other < Count; ++other)
    {
      // Without branches, which a processor cannot predict here.
      const auto isEqual = static_cast<std::uint8_t>(xy[one] == xy[other]);
      const auto isBefore =
        static_cast<std::uint8_t>((xy[one] < xy[other]) | (isEqual & (z[one] < z[other])));
      const auto isBehind =
        static_cast<std::uint8_t>((xy[one] > xy[other]) | (isEqual & (z[one] > z[other])));
      numbers[other] = static_cast<std::uint8_t>(numbers[other] + isBefore);
      numbers[one] = static_cast<std::uint8_t>(numbers[one] + isBehind);
    }
  }
}

} // namespace bricks

#endif
