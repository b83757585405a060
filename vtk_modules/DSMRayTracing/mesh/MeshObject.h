// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshObject_h
#define rt_MeshObject_h

#include "DSMRayTracing/look/ColorMap.h"
#include "DSMRayTracing/look/EdgeLines.h"
#include "DSMRayTracing/look/Material.h"
#include "DSMRayTracing/look/Texture.h"
#include "DSMRayTracing/mesh/MeshInstance.h"
#include "DSMRayTracing/ray/ClipRegion.h"

#include <memory>
#include <optional>

namespace rt
{

class ObjectDigest;
template <class Store>
class MeshTracer;

/// Appearance of a mesh.
struct MeshLook
{
  /// Source of the color at a point of the surface.
  enum class Coloring
  {
    Material,     ///< the diffuse color
    Values,       ///< the color of the interpolated value
    CornerValues, ///< the interpolated colors of the corners' values
    Colors        ///< the mesh's own colors
  };
  Coloring ColoredBy = Coloring::Material;
  /// Color map for the values; not null when they define the color.
  std::shared_ptr<const ColorMap> Colors;
  /// Times the color, where the mesh has texture coordinates; may be null.
  std::shared_ptr<const Texture> Picture;
  /// Shaded by the triangles' planes, also where points have normals.
  bool Flat = false;
  Material Surface;
  /// Material of the side from which a triangle's corners are clockwise; if empty, both sides are
  /// alike.
  std::optional<Material> BackSurface;
  std::optional<EdgeLines> Edges;
};

/// The triangles of one mesh at one place.
struct MeshObject
{
  template <class Store>
  using Tracer = MeshTracer<Store>;

  std::shared_ptr<const MeshInstance> Instance;
  MeshLook Look;
  ClipRegion Clipping;

  /// Returns whether the mesh lets no light through anywhere. Colors of its own and a texture are
  /// not examined: a mesh with these counts as translucent.
  bool IsOpaque() const;
  /// All that the first hits of rays depend on.
  void AddShapeTo(ObjectDigest& digest) const;
  /// All that a picture of it depends on.
  void AddTo(ObjectDigest& digest) const;
};

} // namespace rt

#endif
