// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Scene_h
#define rt_Scene_h

#include "DSMRayTracing/light/Light.h"
#include "DSMRayTracing/light/LightTransport.h"
#include "DSMRayTracing/scene/DebugView.h"
#include "DSMRayTracing/scene/SceneMedium.h"
#include "DSMRayTracing/scene/SceneObject.h"

#include <algorithm>
#include <variant>
#include <vector>

namespace rt
{

/// All that one frame shows.
struct Scene
{
  std::vector<SceneObject> Objects;
  std::vector<SceneMedium> Media;
  std::vector<Light> Lights;
  LightTransport Transport;
  DebugView View = DebugView::Off;

  /// Returns whether no object lets light through.
  bool IsOpaque() const
  {
    return this->Media.empty() &&
      std::all_of(this->Objects.begin(), this->Objects.end(),
        [](const SceneObject& object)
        { return std::visit([](const auto& known) { return known.IsOpaque(); }, object); });
  }
};

} // namespace rt

#endif
