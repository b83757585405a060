// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ObjectTracers_h
#define rt_ObjectTracers_h

#include "DSMRayTracing/field/lattice/LatticeSampler.h"
#include "DSMRayTracing/field/lattice/LatticeSurfaces.h"
#include "DSMRayTracing/mesh/MeshTracer.h"
#include "DSMRayTracing/object/ObjectTracer.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/surface/IsosurfaceTracer.h"

#include <cstddef>
#include <memory>
#include <type_traits>
#include <variant>
#include <vector>

namespace rt
{

/// Of the objects of a scene, in the order in which they are asked for hits: kind by kind.
using ObjectTracers = std::vector<std::unique_ptr<const ObjectTracer>>;

/// For one worker. They keep references to everything.
template <class Store>
ObjectTracers CreateObjectTracers(Store& store, typename Store::Worker& worker, const Scene& scene)
{
  const auto create = [&](const auto& object) -> std::unique_ptr<const ObjectTracer>
  {
    using Tracer = typename std::decay_t<decltype(object)>::template Tracer<Store>;
    return std::make_unique<Tracer>(store, worker, object);
  };
  ObjectTracers tracers;
  for (std::size_t kind = 0; kind < std::variant_size_v<SceneObject>; ++kind)
  {
    for (const SceneObject& object : scene.Objects)
    {
      if (object.index() == kind)
      {
        tracers.push_back(std::visit(create, object));
      }
    }
  }
  return tracers;
}

} // namespace rt

#endif
