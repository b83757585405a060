// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshTracer_h
#define rt_MeshTracer_h

#include "DSMCore/base/Block.h"
#include "DSMRayTracing/mesh/MeshHit.h"
#include "DSMRayTracing/mesh/MeshInstance.h"
#include "DSMRayTracing/mesh/MeshKernel.h"
#include "DSMRayTracing/mesh/MeshPacket.h"
#include "DSMRayTracing/ray/Ray.h"

namespace rt
{

/// Finds the hits of meshes through a store: walks the hierarchy over the bricks front to back,
/// acquires each brick whose box a ray meets before its nearest hit so far, and searches it. Pure:
/// the result depends on the ray and the mesh only; see ComesFirst for hits at the same T. One for
/// each worker: it holds at most one pin, and none while it acquires or when a call returns.
template <class Store>
class MeshTracer
{
public:
  MeshTracer(
    Store& store, typename Store::Worker& worker, const MeshKernel& kernel = MeshKernel::GetBest())
    : Blocks(store)
    , Self(worker)
    , Kernel(kernel)
  {
  }

  /// The first hit in [ray.Min, ray.Max]. May wait for bricks.
  bool Intersect(const MeshInstance& instance, const Ray& ray, MeshHit& hit) const;

  /// Intersect for those of MeshPacket::Size rays that are `wanted`, with the same results. Returns
  /// those that hit something. A brick is acquired once for all that meet it.
  MeshPacket::Mask Intersect(
    const MeshInstance& instance, const Ray* rays, MeshPacket::Mask wanted, MeshHit* hits) const;

  /// Whether there is any hit in [ray.Min, ray.Max]: whether Intersect finds one. May wait for
  /// bricks.
  bool IsOccluded(const MeshInstance& instance, const Ray& ray) const;

  /// The same for those of MeshPacket::Size rays that are `wanted`.
  MeshPacket::Mask FindOccluded(
    const MeshInstance& instance, const Ray* rays, MeshPacket::Mask wanted) const;

private:
  class PacketVisitor;
  class OcclusionVisitor;

  Store& Blocks;
  typename Store::Worker& Self;
  const MeshKernel& Kernel;
};

} // namespace rt

#include "DSMRayTracing/mesh/MeshTracer.txx"

#endif
