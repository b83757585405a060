// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CornerOrder_h
#define bricks_CornerOrder_h

#include <cstdint>

namespace bricks
{

/// Numbers the corners of a cell by their places in the space of the bricks (x first, then y, then z): the number of a
/// corner is the count of corners before it, and equal places have equal numbers. Every cell and every rank orders the
/// corners of a face alike. Places are finite, and their zeros are positive (PlaceInBrick).
template <int Count>
inline void OrderCorners(const float places[][3], std::uint8_t numbers[Count])
{
  // All by all, axis by axis, without branches: the compiler makes vectors of it, and a processor could not predict
  // which corner is before which.
  float x[Count];
  float y[Count];
  float z[Count];
  std::int32_t before[Count] = {};
  for (int corner = 0; corner < Count; ++corner)
  {
    x[corner] = places[corner][0];
    y[corner] = places[corner][1];
    z[corner] = places[corner][2];
  }
  for (int one = 0; one < Count; ++one)
  {
    for (int other = 0; other < Count; ++other)
    {
      const bool isBeforeInFace =
        (y[one] < y[other]) | ((y[one] == y[other]) & (z[one] < z[other]));
      before[other] += (x[one] < x[other]) | ((x[one] == x[other]) & isBeforeInFace);
    }
  }
  for (int corner = 0; corner < Count; ++corner)
  {
    numbers[corner] = static_cast<std::uint8_t>(before[corner]);
  }
}

} // namespace bricks

#endif
