// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Occluders_h
#define rt_Occluders_h

#include "DSMRayTracing/scene/Scene.h"

#include <vector>

namespace rt
{

/// The objects of a scene that let no light through anywhere, so that any hit decides on a light ray.
/// Colours of a mesh's own and textures are not looked through: objects with such count as others.
class Occluders
{
public:
  explicit Occluders(const Scene& scene);

  bool Has(const IsosurfaceObject& object) const
  {
    return this->Isosurfaces[&object - this->World.Isosurfaces.data()];
  }
  bool Has(const MeshObject& object) const
  {
    return this->Meshes[&object - this->World.Meshes.data()];
  }
  /// Whether there is nothing else in the scene.
  bool AreAll() const { return this->All; }

private:
  const Scene& World;
  std::vector<bool> Isosurfaces;
  std::vector<bool> Meshes;
  bool All = true;
};

} // namespace rt

#endif
