// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneTracers_inl_h
#define rt_SceneTracers_inl_h

#include "DSMRayTracing/field/FieldSearches.h"
#include "DSMRayTracing/mesh/MeshTracer.h"
#include "DSMRayTracing/scene/OtherKindDescription.h"
#include "DSMRayTracing/scene/SceneTracers.h"
#include "DSMRayTracing/slice/SliceTracer.h"
#include "DSMRayTracing/surface/IsosurfaceTracer.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <variant>

namespace rt
{

template <class Store, class Kind>
auto CreateTracer(Store& store, typename Store::Worker& worker, const Kind& described)
{
  return std::make_unique<typename Kind::template Tracer<Store>>(store, worker, described);
}
template <class Store, class TracerType>
auto CreateTracer(
  Store& store, typename Store::Worker& worker, const OtherKind<TracerType>& described)
{
  return described.Get().CreateTracer(store, worker);
}

template <class Store>
SceneTracers CreateSceneTracers(Store& store, typename Store::Worker& worker, const Scene& scene)
{
  SceneTracers tracers;
  tracers.MediumErrors = scene.Transport.MediumErrors;
  for (std::size_t kind = 0; kind < std::variant_size_v<SceneObject>; ++kind)
  {
    for (std::size_t number = 0; number < scene.Objects.size(); ++number)
    {
      if (scene.Objects[number].index() == kind)
      {
        auto tracer = std::visit([&](const auto& known) -> std::unique_ptr<ObjectTracer>
          { return CreateTracer(store, worker, known); },
          scene.Objects[number]);
        tracer->SetNumber(static_cast<std::int32_t>(number));
        tracers.Objects.push_back(std::move(tracer));
      }
    }
  }
  for (const SceneMedium& medium : scene.Media)
  {
    tracers.Media.push_back(std::visit([&](const auto& known) -> std::unique_ptr<const MediumTracer>
      { return CreateTracer(store, worker, known); },
      medium));
  }
  return tracers;
}

} // namespace rt

#endif
