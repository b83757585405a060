// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/SceneDigest.h"

#include "DSMRayTracing/object/ObjectDigest.h"

#include <variant>

namespace rt
{

namespace
{

void Add(ObjectDigest& digest, const Light& light)
{
  const auto& [kind, isLoneHeadlight, direction, color, ambientColor] = light;
  digest.AddAll(kind.index(), isLoneHeadlight, direction, color, ambientColor);
  std::visit([&](const auto& known) { known.AddTo(digest); }, kind);
}

void Add(ObjectDigest& digest, const LightTransport& transport)
{
  const auto& [shadows, twoSided, faintShadows, lightRadius, occlusionSamples, occlusionDistance,
    surroundings, mediumErrors, maxBounces, background] = transport;
  const auto& [up, lower, upper] = surroundings;
  digest.AddAll(shadows, twoSided, faintShadows, lightRadius, occlusionSamples, occlusionDistance,
    up, lower, upper, mediumErrors, maxBounces, background);
}

} // namespace

std::uint64_t GetSceneDigest(const Scene& scene, const FrameRequest& request)
{
  ObjectDigest digest;
  // The samples of a picture are added to one another.
  const auto& [width, height, worldToClip, pixelSize, tileSize, firstSample, samples, tolerance,
    layers, limits, mediumCuts, channels, scheduling, keepsHits] = request;
  digest.AddAll(width, height, worldToClip, pixelSize, tileSize, tolerance, layers, limits,
    mediumCuts, channels);
  Add(digest, scene.Transport);
  digest.Add(scene.View);
  digest.Add(scene.Lights.size());
  for (const Light& light : scene.Lights)
  {
    Add(digest, light);
  }
  for (const SceneObject& object : scene.Objects)
  {
    digest.Add(object.index());
    std::visit([&](const auto& known) { known.AddTo(digest); }, object);
  }
  digest.Add(scene.Media.size());
  for (const SceneMedium& medium : scene.Media)
  {
    digest.Add(medium.index());
    std::visit([&](const auto& known) { known.AddTo(digest); }, medium);
  }
  return digest.Get();
}

std::uint64_t GetShapeDigest(const Scene& scene)
{
  ObjectDigest digest;
  for (const SceneObject& object : scene.Objects)
  {
    digest.Add(object.index());
    std::visit([&](const auto& known) { known.AddShapeTo(digest); }, object);
  }
  return digest.Get();
}

} // namespace rt
