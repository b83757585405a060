// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshSearch_h
#define rt_MeshSearch_h

#include "DSMCore/base/Block.h"
#include "DSMRayTracing/mesh/MeshHit.h"
#include "DSMRayTracing/mesh/MeshInstance.h"
#include "DSMRayTracing/mesh/MeshKernel.h"
#include "DSMRayTracing/mesh/MeshPacket.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

namespace rt
{

/// Finds the hits of meshes through a store: walks the hierarchy over the bricks front to back,
/// acquires each brick whose box a ray meets before its nearest hit so far, and searches it. Pure:
/// the result depends on the ray and the mesh only; see ComesFirst for hits at the same T. One for
/// each worker: it holds at most one pin, and none while it acquires or when a call returns.
template <class Store>
class MeshSearch
{
public:
  MeshSearch(
    Store& store, typename Store::Worker& worker, const MeshKernel& kernel = MeshKernel::GetBest())
    : Blocks(store)
    , Self(worker)
    , Kernel(kernel)
  {
  }

  /// The first hit in [ray.Min, ray.Max]. May wait for bricks.
  bool Intersect(const MeshInstance& instance, const Ray& ray, MeshHit& hit) const;

  /// Intersect for those of a batch of rays that are `wanted`, with the same results. Returns those that hit something,
  /// and calls `take(index, t)` for each of them, which returns where to write the hit, or null if it is not needed. A
  /// brick is acquired once for all rays that meet it.
  template <class Take>
  RayMask Intersect(
    const MeshInstance& instance, const Ray* rays, RayMask wanted, const Take& take) const;

  /// Returns whether there is any hit in [ray.Min, ray.Max], that is, whether Intersect finds one.
  /// May wait for bricks.
  bool IsOccluded(const MeshInstance& instance, const Ray& ray) const;

  /// The same for those of a batch of rays that are `wanted`.
  RayMask FindOccluded(const MeshInstance& instance, const Ray* rays, RayMask wanted) const;

private:
  /// Fewer rays go one by one, which takes less time.
  static constexpr int LeastPacket = 4;

  class PacketVisitor;
  class OcclusionVisitor;

  /// Takes the `wanted` rays through the bricks of the mesh.
  template <class Visitor>
  void VisitBricks(
    const MeshInstance& instance, const Ray* rays, RayMask wanted, Visitor& visitor) const;

  Store& Blocks;
  typename Store::Worker& Self;
  const MeshKernel& Kernel;
};

} // namespace rt

#include "DSMRayTracing/mesh/MeshSearch.txx"

#endif
