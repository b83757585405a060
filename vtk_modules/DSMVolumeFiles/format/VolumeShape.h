// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_VolumeShape_h
#define vol_VolumeShape_h

#include "DSMRayTracing/base/Box.h"

#include <cstdint>

namespace vol
{

/// Of several arrays beside one another, those of the largest shape are one volume.
struct VolumeShape
{
  rt::Index3 Samples{ 0 };
  std::int64_t Times = 0; ///< along an axis of time; 0: it has none

  /// More samples, or as many with more times.
  bool IsLargerThan(const VolumeShape& other) const
  {
    const auto count = [](const VolumeShape& shape) {
      return rt::Box{ rt::Index3(0), shape.Samples }.GetCount();
    };
    return count(*this) > count(other) ||
      (this->Samples == other.Samples && this->Times > other.Times);
  }
  /// Whether it belongs to the volume of the largest: what has no time is there at all times.
  bool BelongsTo(const VolumeShape& largest) const
  {
    return this->Samples == largest.Samples && (this->Times == 0 || this->Times == largest.Times);
  }
};

} // namespace vol

#endif
