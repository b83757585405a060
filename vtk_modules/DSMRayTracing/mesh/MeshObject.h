// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshObject_h
#define rt_MeshObject_h

#include "DSMRayTracing/mesh/MeshInstance.h"
#include "DSMRayTracing/ray/ClipRegion.h"
#include "DSMRayTracing/surface/ColorMap.h"
#include "DSMRayTracing/surface/EdgeLines.h"
#include "DSMRayTracing/surface/Material.h"
#include "DSMRayTracing/surface/Texture.h"

#include <memory>
#include <optional>

namespace rt
{

class ObjectDigest;
template <class Store>
class MeshTracer;

/// The triangles of one mesh at one place.
struct MeshObject
{
  template <class Store>
  using Tracer = MeshTracer<Store>;

  /// Where a point of the surface has its colour from.
  enum class Coloring
  {
    Material,     ///< the diffuse colour
    Values,       ///< the colour of the interpolated value
    CornerValues, ///< the interpolated colours of the corners' values
    Colors        ///< the mesh's own colours
  };
  std::shared_ptr<const MeshInstance> Instance;
  Coloring ColoredBy = Coloring::Material;
  /// Of the values; not null when they give the colour.
  std::shared_ptr<const ColorMap> Colors;
  /// Times the colour, where the mesh has texture coordinates; may be null.
  std::shared_ptr<const Texture> Picture;
  /// Shaded by the triangles' planes, also where points have normals.
  bool Flat = false;
  Material Surface;
  /// Of the side from which a triangle's corners are clockwise; without, both sides are alike.
  std::optional<Material> BackSurface;
  std::optional<EdgeLines> Edges;
  ClipRegion Clipping;

  /// Whether it lets no light through anywhere. Colours of its own and a texture are not looked through:
  /// with such it may.
  bool IsOpaque() const;
  /// All that a picture of it depends on.
  void AddTo(ObjectDigest& digest) const;
};

} // namespace rt

#endif
