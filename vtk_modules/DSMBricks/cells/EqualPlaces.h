// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_EqualPlaces_h
#define bricks_EqualPlaces_h

#include "DSMCore/base/FunctionRef.h"

#include <cstdint>
#include <vector>

namespace bricks
{

/// Writes the place of a point. Returns false for a point without one. Called by any thread, several times for a point.
using GetPlaceFunction = dsm::FunctionRef<bool(std::uint64_t point, float place[3])>;

/// Points that have the same place: bit-equal floats. Zeros are positive.
struct EqualPlaces
{
  std::vector<std::uint32_t>
    Points; ///< two or more of each place, in ascending order, place after place
  std::vector<std::uint32_t> Ends; ///< of the places in Points

  /// Calls visit(points, count) for each place.
  template <class Visit>
  void ForEach(const Visit& visit) const
  {
    std::uint32_t begin = 0;
    for (const std::uint32_t end : this->Ends)
    {
      visit(this->Points.data() + begin, end - begin);
      begin = end;
    }
  }
};

/// A hash of a place; the same on all ranks.
std::uint64_t HashPlace(const float place[3]);

/// Finds which of the points [0, count) have the same place. The result does not depend on the number of threads.
/// Takes 16 bytes a point while it runs. Throws what `getPlace` throws, and dsm::Error for more points than 32 bits
/// can number.
EqualPlaces FindEqualPlaces(std::uint64_t count, GetPlaceFunction getPlace, int threads);

} // namespace bricks

#endif
