// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ArrivingLight_h
#define rt_ArrivingLight_h

#include "DSMRayTracing/frame/LightPath.h"
#include "DSMRayTracing/light/Shading.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/scene/TransmittanceFinder.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace rt
{

/// How much light of lamps, and from all around, arrives at the surfaces that paths have come to. One for
/// each worker.
class ArrivingLight
{
public:
  /// Keeps references to the scene and the tracers of its objects.
  ArrivingLight(const SceneTracers& tracers, const Scene& scene);

  /// The points that paths are at, at most MaxRays, with the light from all around.
  std::vector<ShadingPoint> FindPoints(LightPath* const* paths, int count) const;

  /// For lamp after lamp, MaxRays apart, its light that arrives at each of the points, where there are shadows. Empty:
  /// all of it.
  std::vector<LightSample> FindArriving(
    LightPath* const* paths, int count, const ShadingPoint* points) const;

  /// The point that a path is at, as if nothing were near it.
  ShadingPoint GetPoint(const LightPath& path) const;

private:
  void LookAround(LightPath* const* paths, int count, ShadingPoint* points) const;
  void FindVisibility(std::size_t lamp, LightPath* const* paths, int count,
    const ShadingPoint* points, const LightSample* samples, glm::dvec3* visibility) const;
  Ray GetLightRay(const LightSample& light, LightPath& path) const;
  Ray GetOcclusionRay(const glm::dvec3& normal, LightPath& path) const;

  TransmittanceFinder Transmittances;
  const Scene& World;
  bool HasSurroundings; ///< light comes from everywhere
};

} // namespace rt

#endif
