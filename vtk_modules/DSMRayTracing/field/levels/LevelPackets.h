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
#include <cstddef>
#include <memory>
#include <numeric>
#include <vector>

namespace rt
{

/// A packet in the index spaces of all levels: the same rays, each at the same T.
class LevelPackets
{
public:
  explicit LevelPackets(const LevelField& field)
    : Voxels(*field.Voxels)
    , Scaled(static_cast<std::size_t>(this->Voxels.Lattice.GetScales().GetCount()))
  {
  }

  /// In that of level 0; call Begin when it is filled.
  RayPacket& GetCoarsest() { return this->Coarsest; }
  void Begin() { this->Scaled = decltype(this->Scaled)(this->Scaled.size()); }

  /// In that of a brick.
  RayPacket& Get(dsm::BlockId id)
  {
    const int level = this->Voxels.Lattice.GetBrick(id).Level;
    std::unique_ptr<RayPacket>& packet = this->Scaled[static_cast<std::size_t>(level)];
    if (!packet)
    {
      packet = std::make_unique<RayPacket>(this->Coarsest);
      const glm::dvec3 scale = this->GetScale(id);
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

  /// Cells of a brick's level in one of level 0.
  glm::dvec3 GetScale(dsm::BlockId id) const
  {
    const bricks::LevelLattice& lattice = this->Voxels.Lattice;
    return glm::dvec3(lattice.GetScales().Get(lattice.GetBrick(id).Level));
  }
  const bricks::ValueRange& GetRange(dsm::BlockId id) const
  {
    return this->Voxels.Hierarchy.GetRange(id);
  }
  /// An order of the bricks that does not depend on the packet.
  std::vector<std::size_t> GetOrder(const BeamBricks& bricks) const
  {
    std::vector<std::size_t> order(bricks.Bricks.size());
    std::iota(order.begin(), order.end(), std::size_t{ 0 });
    std::sort(order.begin(), order.end(),
      [&](std::size_t one, std::size_t other)
      { return bricks.Bricks[one].Id < bricks.Bricks[other].Id; });
    return order;
  }

private:
  const bricks::LevelVoxels& Voxels;
  RayPacket Coarsest;
  std::vector<std::unique_ptr<RayPacket>> Scaled;
};

/// FillPackets for levels: calls `visit(bricks, packets)` with the bricks whose values satisfy `mayHold`.
template <class Predicate, class Visit>
RayMask ForEachPacket(const LevelField& field, const Predicate& mayHold, const PacketKernel& kernel,
  BeamBricks* beam, const Ray* rays, RayMask wanted, const Visit& visit)
{
  const bricks::LevelLattice& lattice = field.Voxels->Lattice;
  LevelPackets packets(field);
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
