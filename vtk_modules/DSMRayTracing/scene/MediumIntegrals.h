// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumIntegrals_h
#define rt_MediumIntegrals_h

#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/scene/SceneBeam.h"
#include "DSMRayTracing/scene/SceneTracers.h"

#include <algorithm>
#include <cstddef>

namespace rt
{

/// Integrals along rays through all media of a scene that have any. One for each worker; keeps a reference.
class MediumIntegrals
{
public:
  explicit MediumIntegrals(const SceneTracers& tracers)
    : Media(tracers.Media)
    , FirstBeam(tracers.Objects.size())
  {
  }

  /// The sums over the media, in [ray.Min, ray.Max] of those of the rays that are `wanted`. `beam`: contains all of
  /// the rays; null: the rays have any direction.
  void Find(const Ray* rays, RayMask wanted, SceneBeam* beam, double integrals[MaxRays]) const
  {
    std::fill_n(integrals, MaxRays, 0.0);
    for (std::size_t medium = 0; medium < this->Media.size(); ++medium)
    {
      ObjectBeam* const own = beam ? beam->Objects[this->FirstBeam + medium].get() : nullptr;
      this->Media[medium]->Integrate(rays, wanted, own, integrals);
    }
  }

private:
  const MediumTracers& Media;
  std::size_t FirstBeam; ///< index in SceneBeam
};

} // namespace rt

#endif
