// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/scene/Occluders.h"

#include <algorithm>

namespace rt
{

namespace
{

bool IsOpaque(const glm::vec4& color)
{
  return color.w >= 1.0f;
}

bool IsOpaque(const ColorMap& map)
{
  return IsOpaque(map.Below) && IsOpaque(map.Above) && IsOpaque(map.NotANumber) &&
    std::all_of(
      map.Table.begin(), map.Table.end(), [](const glm::vec4& color) { return IsOpaque(color); });
}

bool IsOpaque(const IsosurfaceObject& object)
{
  return object.Surface.Opacity >= 1.0f && (!object.ColorField || IsOpaque(object.Colors)) &&
    std::all_of(object.Opacities.begin(), object.Opacities.end(),
      [](float opacity) { return opacity >= 1.0f; });
}

bool IsOpaque(const MeshObject& object)
{
  return object.Surface.Opacity >= 1.0f &&
    (!object.BackSurface || object.BackSurface->Opacity >= 1.0f) && !object.Picture &&
    (object.ColoredBy == MeshObject::Coloring::Material ||
      (object.ColoredBy != MeshObject::Coloring::Colors && IsOpaque(*object.Colors)));
}

} // namespace

Occluders::Occluders(const Scene& scene)
  : World(scene)
{
  for (const IsosurfaceObject& object : scene.Isosurfaces)
  {
    this->Isosurfaces.push_back(IsOpaque(object));
    this->All = this->All && this->Isosurfaces.back();
  }
  for (const MeshObject& object : scene.Meshes)
  {
    this->Meshes.push_back(IsOpaque(object));
    this->All = this->All && this->Meshes.back();
  }
}

} // namespace rt
