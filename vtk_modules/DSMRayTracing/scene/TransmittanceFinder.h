// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TransmittanceFinder_h
#define rt_TransmittanceFinder_h

#include "DSMRayTracing/scene/ObjectTracers.h"
#include "DSMRayTracing/scene/SurfaceFinder.h"

#include <glm/vec3.hpp>

#include <vector>

namespace rt
{

/// How much of each colour of light gets along rays: none where an opaque surface is anywhere on the
/// way; translucent surfaces dim and tint it, from the ray's origin on. One for each worker.
class TransmittanceFinder
{
public:
  /// Keeps references to the tracers.
  explicit TransmittanceFinder(const ObjectTracers& objects);

  /// For `count` rays, at most MaxRays.
  void Find(const Ray* rays, int count, glm::dvec3* transmittances) const;

private:
  /// Less than half a step of an 8-bit channel.
  static constexpr double Dark = 0.5 / 255.0;

  /// What objects that are not opaque leave of the light.
  void FindTints(const Ray* rays, RayMask wanted, glm::dvec3* transmittances) const;

  /// Any hit of these decides.
  std::vector<const ObjectTracer*> Opaque;
  SurfaceFinder Others;
};

} // namespace rt

#endif
