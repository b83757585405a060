// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneTracers_inl_h
#define rt_SceneTracers_inl_h

#include "DSMRayTracing/field/FieldSearches.h"
#include "DSMRayTracing/mesh/MeshTracer.h"
#include "DSMRayTracing/scene/SceneTracers.h"
#include "DSMRayTracing/slice/SliceTracer.h"
#include "DSMRayTracing/surface/IsosurfaceTracer.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

namespace rt
{

template <class Store>
SceneTracers CreateSceneTracers(Store& store, typename Store::Worker& worker, const Scene& scene)
{
  const auto create = [&](const auto& described)
  {
    using Tracer = typename std::decay_t<decltype(described)>::template Tracer<Store>;
    return std::make_unique<Tracer>(store, worker, described);
  };
  SceneTracers tracers;
  for (std::size_t kind = 0; kind < std::variant_size_v<SceneObject>; ++kind)
  {
    for (std::size_t number = 0; number < scene.Objects.size(); ++number)
    {
      if (scene.Objects[number].index() == kind)
      {
        auto tracer = std::visit([&](const auto& known) -> std::unique_ptr<ObjectTracer>
          { return create(known); },
          scene.Objects[number]);
        tracer->SetNumber(static_cast<std::int32_t>(number));
        tracers.Objects.push_back(std::move(tracer));
      }
    }
  }
  for (const SceneMedium& medium : scene.Media)
  {
    tracers.Media.push_back(std::visit([&](const auto& known) -> std::unique_ptr<const MediumTracer>
      { return create(known); },
      medium));
  }
  return tracers;
}

} // namespace rt

#endif
