// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_RayIntegrals_h
#define rt_RayIntegrals_h

#include "DSMRayTracing/ray/RayMask.h"

#include <algorithm>
#include <limits>

namespace rt
{

/// Integrals of values along the rays of a batch, over T.
struct RayIntegrals
{
  /// Begins with the `wanted` rays.
  explicit RayIntegrals(RayMask wanted)
  {
    ForEachRay(wanted,
      [&](int ray)
      {
        this->Sum[ray] = 0.0;
        this->First[ray] = std::numeric_limits<double>::infinity();
      });
  }

  /// `mean`: of the values from `enter` to `leave`.
  void Add(int ray, double enter, double leave, double mean)
  {
    this->Sum[ray] += (leave - enter) * mean;
    this->First[ray] = std::min(this->First[ray], enter);
  }

  double Sum[MaxRays];
  double First[MaxRays]; ///< T where there are values first; infinite: nowhere
};

} // namespace rt

#endif
