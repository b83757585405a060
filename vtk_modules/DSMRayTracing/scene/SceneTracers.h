// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneTracers_h
#define rt_SceneTracers_h

#include "DSMRayTracing/field/lattice/LatticeExtrema.h"
#include "DSMRayTracing/field/lattice/LatticeMedia.h"
#include "DSMRayTracing/field/lattice/LatticeSampler.h"
#include "DSMRayTracing/field/lattice/LatticeSections.h"
#include "DSMRayTracing/field/lattice/LatticeSurfaces.h"
#include "DSMRayTracing/field/levels/LevelExtrema.h"
#include "DSMRayTracing/field/levels/LevelMedia.h"
#include "DSMRayTracing/field/levels/LevelSampler.h"
#include "DSMRayTracing/field/levels/LevelSections.h"
#include "DSMRayTracing/field/levels/LevelSurfaces.h"
#include "DSMRayTracing/mesh/MeshTracer.h"
#include "DSMRayTracing/object/BeamFinder.h"
#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/object/ObjectTracer.h"
#include "DSMRayTracing/scene/Scene.h"
#include "DSMRayTracing/slice/SliceTracer.h"
#include "DSMRayTracing/surface/IsosurfaceTracer.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace rt
{

/// Tracers of a scene's objects, grouped by kind; the tracer queries them in this order.
using ObjectTracers = std::vector<std::unique_ptr<const ObjectTracer>>;
using MediumTracers = std::vector<std::unique_ptr<const MediumTracer>>;

/// Tracers of everything in a scene, for one worker.
struct SceneTracers
{
  ObjectTracers Objects;
  MediumTracers Media;

  /// Objects first: in the order of SceneBeam.
  std::vector<const BeamFinder*> GetBeamFinders() const
  {
    std::vector<const BeamFinder*> all;
    for (const auto& object : this->Objects)
    {
      all.push_back(object.get());
    }
    for (const auto& medium : this->Media)
    {
      all.push_back(medium.get());
    }
    return all;
  }
};

/// They keep references to everything.
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
