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

/// What a mesh looks like.
struct MeshLook
{
  /// Where a point of the surface has its color from.
  enum class Coloring
  {
    Material,     ///< the diffuse color
    Values,       ///< the color of the interpolated value
    CornerValues, ///< the interpolated colors of the corners' values
    Colors        ///< the mesh's own colors
  };
  Coloring ColoredBy = Coloring::Material;
  /// Of the values; not null when they give the color.
  std::shared_ptr<const ColorMap> Colors;
  /// Times the color, where the mesh has texture coordinates; may be null.
  std::shared_ptr<const Texture> Picture;
  /// Shaded by the triangles' planes, also where points have normals.
  bool Flat = false;
  Material Surface;
  /// Of the side from which a triangle's corners are clockwise; without, both sides are alike.
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

  /// Whether it lets no light through anywhere. Colors of its own and a texture are not looked through:
  /// with such it may.
  bool IsOpaque() const;
  /// All that a picture of it depends on.
  void AddTo(ObjectDigest& digest) const;
};

} // namespace rt

#endif
