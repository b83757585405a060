// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_RayExtrema_h
#define rt_RayExtrema_h

#include "DSMRayTracing/ray/RayMask.h"

#include <algorithm>

namespace rt
{

/// The largest value that each ray of a batch has met so far, and where it met it first; or the smallest one, which is
/// the largest one with the opposite sign.
struct RayExtrema
{
  /// Begins with the `wanted` rays. Only values beyond `limit` (times the sign) count.
  RayExtrema(RayMask wanted, bool isMinimum, double limit, double goal)
    : Sign(isMinimum ? -1.0 : 1.0)
    , Goal(goal)
  {
    ForEachRay(wanted, [&](int ray) { this->Value[ray] = limit; });
  }

  /// The smallest of those of some rays: what is not above it is of no use to any of them.
  double GetLeast(RayMask rays) const
  {
    double least = this->Value[GetLowest(rays)];
    ForEachRay(rays, [&](int ray) { least = std::min(least, this->Value[ray]); });
    return least;
  }

  double Sign;
  double Goal;           ///< a ray that has met this value (times the sign) is done
  double Value[MaxRays]; ///< times the sign
  double T[MaxRays];     ///< valid for rays in Found
  RayMask Found = 0;     ///< rays that have met any value that counts
};

} // namespace rt

#endif
