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
  digest.Add(light.Type);
  digest.Add(light.IsLoneHeadlight);
  digest.Add(light.Position);
  digest.Add(light.Direction);
  digest.Add(light.Color);
  digest.Add(light.AmbientColor);
  digest.Add(light.ConeCosine);
  digest.Add(light.Exponent);
  digest.Add(light.Attenuation);
}

void Add(ObjectDigest& digest, const LightTransport& transport)
{
  digest.Add(transport.Shadows);
  digest.Add(transport.TwoSided);
  digest.Add(transport.FaintShadows);
  digest.Add(transport.LightRadius);
  digest.Add(transport.AmbientOcclusionSamples);
  digest.Add(transport.AmbientOcclusionDistance);
  digest.Add(transport.Surroundings.Up);
  digest.Add(transport.Surroundings.Lower);
  digest.Add(transport.Surroundings.Upper);
  digest.Add(transport.MaxBounces);
  digest.Add(transport.Background);
}

} // namespace

std::uint64_t GetSceneDigest(const Scene& scene, const FrameRequest& request)
{
  ObjectDigest digest;
  digest.Add(request.Width);
  digest.Add(request.Height);
  digest.Add(request.WorldToClip);
  digest.Add(request.PixelSize);
  digest.Add(request.TileSize);
  digest.Add(request.Layers);
  digest.Add(request.Limits != nullptr);
  if (request.Limits)
  {
    digest.Add(*request.Limits);
  }
  digest.Add(request.MediumCuts != nullptr);
  if (request.MediumCuts)
  {
    digest.Add(*request.MediumCuts);
  }
  digest.Add(request.Channels);
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

} // namespace rt
