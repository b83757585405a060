// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LightPath_h
#define rt_LightPath_h

#include "DSMRayTracing/frame/KnownLight.h"
#include "DSMRayTracing/frame/PixelSample.h"
#include "DSMRayTracing/light/SampleSequence.h"
#include "DSMRayTracing/object/PictureView.h"
#include "DSMRayTracing/object/SurfacePoint.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>

namespace rt
{

/// A sample of a pixel on its way through the scene, or of what a mirror shows, and the surface that it has
/// come to.
struct LightPath
{
  int Index = 0; ///< index of its ray in the batch
  SurfacePoint Point;
  glm::dvec3 ToViewer{ 0.0 };
  SampleSequence Random;
  glm::vec4 Color{ 0.0f };
  glm::vec3 Open{ 0.0f }; ///< see PixelSample
  int LightRays = 0;
  PixelSample* Layers = nullptr; ///< gets the surfaces one by one, if not null
  /// The picture that the ray belongs to.
  const PictureView* View = nullptr;
  std::int32_t Object = -1; ///< see PixelSample; of the surface that it has come to
  std::uint64_t Number = 0; ///< owner or brick of the surface, for a debug view
  unsigned KnownLamps = 0;  ///< bit *i*: Lamps[i] has a value
  bool KnowsAmbient = false;
  // Last, so that what all paths use is together.
  /// ShadingPoint::AmbientVisibility of a surface in front.
  KnownLight<double> Ambient;
  /// Visibility of the scene's first lamps from surfaces in front.
  static constexpr int MaxKnownLamps = 8;
  KnownLight<glm::dvec3> Lamps[MaxKnownLamps];

  /// Returns the contribution of the surface to the color.
  float GetWeight() const { return (1.0f - this->Color.w) * this->Point.Color.w; }
  bool GoesOn() const { return this->Color.w < OpaqueEnough; }
  /// Moves the start of the ray behind the surface, and its end to `last`.
  void Pass(Ray& ray, double last) const
  {
    ray.Min = this->Point.T + this->Point.Clearance / glm::length(ray.Direction);
    ray.Max = last;
  }

private:
  /// Opacity from which anything behind contributes less than half a step of an 8-bit channel.
  static constexpr float OpaqueEnough = 1.0f - 0.5f / 255.0f;
};

} // namespace rt

#endif
