// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SceneTracers_h
#define rt_SceneTracers_h

#include "DSMRayTracing/object/BeamFinder.h"
#include "DSMRayTracing/object/MediumTracer.h"
#include "DSMRayTracing/object/ObjectTracer.h"
#include "DSMRayTracing/scene/Scene.h"

#include <memory>
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
  double MediumErrors = 1.0; ///< LightTransport

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

/// They keep references to everything. For the stores of dsm::BlockStore: each is compiled once, in a file of its
/// own, since all kinds of objects and media are.
template <class Store>
SceneTracers CreateSceneTracers(Store& store, typename Store::Worker& worker, const Scene& scene);

} // namespace rt

#endif
