// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Scene_h
#define rt_Scene_h

#include "DSMRayTracing/light/Light.h"
#include "DSMRayTracing/light/LightTransport.h"
#include "DSMRayTracing/mesh/MeshObject.h"
#include "DSMRayTracing/scene/DebugView.h"
#include "DSMRayTracing/volume/IsosurfaceObject.h"

#include <vector>

namespace rt
{

/// All that one frame shows.
struct Scene
{
  std::vector<IsosurfaceObject> Isosurfaces;
  std::vector<MeshObject> Meshes;
  std::vector<Light> Lights;
  LightTransport Transport;
  DebugView View = DebugView::Off;
};

} // namespace rt

#endif
