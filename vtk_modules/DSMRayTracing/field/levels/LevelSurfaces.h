// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelSurfaces_h
#define rt_LevelSurfaces_h

#include "DSMRayTracing/field/LevelSets.h"
#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"
#include "DSMRayTracing/field/levels/LevelField.h"
#include "DSMRayTracing/field/levels/LevelSampler.h"
#include "DSMRayTracing/object/ObjectTracer.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <memory>
#include <vector>

namespace rt
{

/// Finds the isosurfaces of levels for batches of rays, brick by brick with the kernels of lattices, in the index
/// space of each brick's level. The counterpart of LatticeSurfaces. A ray finds the same bits, whatever other rays
/// its packet has.
template <class Store>
class LevelSurfaces
{
public:
  using Sets = LevelSets<LevelField>;
  using Hit = LatticeHit;

  LevelSurfaces(Store& store, typename Store::Worker& worker,
    const PacketKernel& kernel = PacketKernel::GetBest())
    : Blocks(store)
    , Self(worker)
    , Values(store, worker)
    , Kernel(kernel)
  {
  }

  /// See ObjectTracer.
  std::unique_ptr<ObjectBeam> FindBeam(const Sets& sets, const Ray corners[4]) const;

  /// See ObjectTracer.
  bool Prefetch(const Sets& sets, const ObjectBeam& beam, std::size_t count) const;

  /// See LatticeSurfaces.
  template <class Open>
  RayMask Intersect(
    const Sets& sets, ObjectBeam* beam, const Ray* rays, RayMask wanted, const Open& open) const;

  RayMask FindOccluded(const Sets& sets, const Ray* rays, RayMask wanted) const;

  /// See LatticeSurfaces.
  RayMask Attenuate(const Sets& sets, const std::vector<glm::dvec3>& sheets, const Ray* rays,
    RayMask wanted, glm::dvec3* transmittances) const;

private:
  struct Nearest;

  /// Calls `search(packet, open, index, surface, origin)` for each brick and isovalue with the rays that meet the
  /// brick, of those that `isOpen(packet)` returns.
  template <class T, class IsOpen, class Search>
  void SearchBricks(const Sets& sets, BeamBricks& bricks, class LevelPackets& packets,
    const IsOpen& isOpen, const Search& search) const;

  Store& Blocks;
  typename Store::Worker& Self;
  LevelSampler<Store> Values;
  const PacketKernel& Kernel;
};

} // namespace rt

#include "DSMRayTracing/field/levels/LevelSurfaces.txx"

#endif
