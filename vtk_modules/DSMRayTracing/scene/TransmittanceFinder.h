// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TransmittanceFinder_h
#define rt_TransmittanceFinder_h

#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/scene/MediaMarcher.h"
#include "DSMRayTracing/scene/SceneTracers.h"

#include <glm/vec3.hpp>

#include <vector>

namespace rt
{

/// How much of each color of light gets along rays: none where an opaque surface is anywhere on the
/// way; translucent surfaces dim and tint it (GetSheetTransmittance), media dim it. One for each worker.
class TransmittanceFinder
{
public:
  /// Keeps references to the tracers.
  explicit TransmittanceFinder(const SceneTracers& tracers);

  /// For `count` rays, at most MaxRays.
  void Find(const Ray* rays, int count, glm::dvec3* transmittances) const;

private:
  /// Any hit of these decides.
  std::vector<const ObjectTracer*> Opaque;
  std::vector<const ObjectTracer*> Others;
  MediaMarcher Media;
};

} // namespace rt

#endif
