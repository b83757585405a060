// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelPackets_h
#define rt_LevelPackets_h

#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/LatticePackets.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"
#include "DSMRayTracing/field/lattice/RayBeam.h"
#include "DSMRayTracing/field/levels/LevelDescent.h"
#include "DSMRayTracing/field/levels/LevelField.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/ray/RayPacket.h"

#include <glm/common.hpp>

#include <algorithm>
#include <memory>
#include <vector>

namespace rt
{

/// A packet in the index spaces of all levels: the same rays, each at the same T.
class LevelPackets
{
public:
  explicit LevelPackets(const bricks::LevelScales& scales)
    : Scales(scales)
    , Scaled(static_cast<std::size_t>(scales.GetCount()))
  {
  }

  /// In that of level 0; call Begin when it is filled.
  RayPacket& GetCoarsest() { return this->Coarsest; }
  void Begin() { this->Scaled = decltype(this->Scaled)(this->Scaled.size()); }

  RayPacket& Get(int level)
  {
    std::unique_ptr<RayPacket>& packet = this->Scaled[static_cast<std::size_t>(level)];
    if (!packet)
    {
      packet = std::make_unique<RayPacket>(this->Coarsest);
      const glm::dvec3 scale(this->Scales.Get(level));
      for (int axis = 0; axis < 3; ++axis)
      {
        for (int ray = 0; ray < RayPacket::Size; ++ray)
        {
          packet->Origin[axis][ray] *= scale[axis];
          packet->Direction[axis][ray] *= scale[axis];
          packet->Inverse[axis][ray] /= scale[axis];
        }
      }
    }
    return *packet;
  }

private:
  const bricks::LevelScales& Scales;
  RayPacket Coarsest;
  std::vector<std::unique_ptr<RayPacket>> Scaled;
};

/// FillPackets for levels: calls `visit(bricks, packets)` with the bricks whose values satisfy `mayHold`.
template <class Predicate, class Visit>
RayMask ForEachLevelPacket(const LevelField& field, const Predicate& mayHold,
  const PacketKernel& kernel, BeamBricks* beam, const Ray* rays, RayMask wanted, const Visit& visit)
{
  const bricks::LevelLattice& lattice = field.Voxels->Lattice;
  LevelPackets packets(lattice.GetScales());
  const bricks::Index3 cells(glm::ceil(lattice.GetBounds()[1]));
  return FillPackets(
    packets.GetCoarsest(), field.GetIndexSpace(), field.IndexToWorld, cells, kernel, beam, rays,
    wanted, [&](const RayBeam& own) { return FindLevelBricks(*field.Voxels, mayHold, own); },
    [&](BeamBricks& bricks)
    {
      packets.Begin();
      return visit(bricks, packets);
    });
}

} // namespace rt

#endif
