// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshTracer_h
#define rt_MeshTracer_h

#include "DSMCore/Block.h"
#include "DSMRayTracing/kernel/MeshInstance.h"
#include "DSMRayTracing/kernel/Ray.h"
#include "DSMRayTracing/kernel/TreeletTraversal.h"
#include "DSMRayTracing/kernel/TriangleAttributes.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace rt
{

/// Where a ray meets a mesh first. World space; normals are unit and not turned to the viewer.
struct MeshHit
{
  double T = 0.0;
  /// Of the triangle's plane; its corners are counter-clockwise seen from the side it points to,
  /// in the mesh's space (a mirroring matrix does not turn the surface inside out).
  glm::dvec3 GeometricNormal{ 0.0 };
  /// Interpolated from the points' normals; where they have none, the geometric one.
  glm::dvec3 Normal{ 0.0 };
  /// Whether the ray comes from the side to which the geometric normal points.
  bool Front = true;
  double Value = 0.0;                  ///< interpolated, or the triangle's; NaN without values
  glm::dvec3 CornerValues{ 0.0 };      ///< in the order of Weights; NaN without values
  glm::vec4 Color{ 1.0f };             ///< in [0, 1], not premultiplied; white without colours
  glm::dvec2 TextureCoordinate{ 0.0 }; ///< 0 without
  /// Of the corners as the brick has them: the smallest position first.
  glm::dvec3 Weights{ 0.0 };
  dsm::BlockId Brick = 0;
  std::uint32_t Triangle = 0; ///< of the brick
};

/// Finds the hits of meshes through a store: walks the hierarchy over the bricks front to back,
/// acquires each brick whose box the ray meets before its nearest hit so far, and searches it
/// (TreeletTraversal). Pure: the result depends on the ray and the mesh only; see ComesFirst for
/// hits at the same T. One for each worker: it holds at most one pin, and none while it acquires or
/// when a call returns.
template <class Store>
class MeshTracer
{
public:
  MeshTracer(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
  {
  }

  /// The first hit in [ray.Min, ray.Max]. May wait for bricks.
  bool Intersect(const MeshInstance& instance, const Ray& ray, MeshHit& hit) const;

private:
  static void Complete(const MeshInstance& instance, const Ray& ray, const TriangleHit& triangle,
    const TriangleAttributes& attributes, MeshHit& hit);

  Store& Blocks;
  typename Store::Worker& Self;
};

} // namespace rt

#include "DSMRayTracing/kernel/MeshTracer.txx"

#endif
