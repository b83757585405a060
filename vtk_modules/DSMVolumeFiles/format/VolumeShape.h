// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_VolumeShape_h
#define vol_VolumeShape_h

#include "DSMBricks/base/Box.h"
#include "DSMVolumeFiles/base/FileLimits.h"

#include <glm/ext/vector_uint3_sized.hpp>

#include <cstdint>

namespace vol
{

/// Shape of an array. The arrays with the largest shape in a group form one volume.
struct VolumeShape
{
  bricks::Index3 Samples{ 0 };
  std::int64_t Times = 0; ///< along an axis of time; 0: it has none

  /// More samples, or as many with more times.
  bool IsLargerThan(const VolumeShape& other) const
  {
    // A file may declare more samples than a 64-bit number counts.
    const auto count = [](const VolumeShape& shape)
    {
      const glm::u64vec3 sides(glm::max(shape.Samples, bricks::Index3(0)));
      return MultiplyWithin(~std::uint64_t(0), { sides.x, sides.y, sides.z })
        .value_or(~std::uint64_t(0));
    };
    return count(*this) > count(other) ||
      (this->Samples == other.Samples && this->Times > other.Times);
  }
  /// Returns whether the array belongs to the volume of the largest shape. An array without a time axis is present
  /// at all times.
  bool BelongsTo(const VolumeShape& largest) const
  {
    return this->Samples == largest.Samples && (this->Times == 0 || this->Times == largest.Times);
  }
};

} // namespace vol

#endif
