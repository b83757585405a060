// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SurfaceFinder_h
#define rt_SurfaceFinder_h

#include "DSMRayTracing/object/ObjectHit.h"
#include "DSMRayTracing/object/ObjectTracer.h"
#include "DSMRayTracing/scene/SceneBeam.h"

#include <vector>

namespace rt
{

/// Finds what rays meet first among objects. One for each worker, as they are.
class SurfaceFinder
{
public:
  /// `objects`: tracers to query, in this order; kept by reference.
  explicit SurfaceFinder(std::vector<const ObjectTracer*> objects);

  bool HasObjects() const { return !this->Objects.empty(); }

  /// The first surfaces in [ray.Min, ray.Max] of those of a batch of rays that are `wanted`; of equally
  /// near ones that of the first object. Returns the rays that meet something, which end there, and what
  /// in `hits`. `beam`: of FindBeam, with all of the rays within; null: they go where they like.
  RayMask Find(Ray* rays, RayMask wanted, SceneBeam* beam, ObjectHit* hits) const;

  /// Describes the surfaces that Find has found for the `wanted` rays. `views`, `points`: see
  /// ObjectTracer::Describe; each object is asked for all of its hits together.
  static void Describe(const ObjectHit* hits, const Ray* rays, const PictureView* const* views,
    RayMask wanted, SurfacePoint* const* points);

private:
  std::vector<const ObjectTracer*> Objects;
};

} // namespace rt

#endif
