// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticePackets_h
#define rt_LatticePackets_h

#include "DSMRayTracing/field/lattice/BeamBricks.h"
#include "DSMRayTracing/field/lattice/BeamDescent.h"
#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/lattice/PacketKernel.h"
#include "DSMRayTracing/field/lattice/RayBeam.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/ray/RayPacket.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace rt
{

/// Makes `moved` move along all three axes, as rays of a packet do. A ray that does not, moves so little that it
/// stays at its place for all that can be seen. Returns the sides to which the ray moves, a bit for each axis.
inline int MoveAlongAll(
  const IndexSpace& space, const glm::dmat4& indexToWorld, const Ray& ray, Ray& moved)
{
  constexpr double least = 1e-10;
  glm::dvec3 direction = space.GetWorldToIndex() * ray.Direction;
  const glm::dvec3 size = glm::abs(direction);
  const double small = least * std::max({ size.x, size.y, size.z });
  int side = 0;
  bool isMoved = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (size[axis] < small)
    {
      direction[axis] = direction[axis] < 0.0 ? -small : small;
      isMoved = true;
    }
    side |= (direction[axis] > 0.0 ? 1 : 0) << axis;
  }
  moved = ray;
  if (isMoved)
  {
    moved.Direction = glm::dmat3(indexToWorld) * direction;
  }
  return side;
}

/// Divides the `wanted` rays of a batch into packets of rays whose directions have the same signs, or of a single
/// ray. For each, fills `packet`, in the index space with so many cells, and calls `visit(bricks)`, which returns
/// some of the rays; the function returns all of these. `beam`: contains all of the rays; null, or not usable:
/// `find(RayBeam)` returns the bricks for each packet.
template <class Find, class Visit>
RayMask FillPackets(RayPacket& packet, const IndexSpace& space, const glm::dmat4& indexToWorld,
  const bricks::Index3& cells, const PacketKernel& kernel, BeamBricks* beam, const Ray* rays,
  RayMask wanted, const Find& find, const Visit& visit)
{
  RayMask found = 0;
  RayMask left = wanted;
  if (beam && beam->Usable)
  {
    std::copy_n(beam->Forward, 3, packet.Forward);
    left = kernel.SetRays(packet, rays, wanted, space, cells);
    found |= visit(*beam);
  }
  if (left == 0)
  {
    return found;
  }
  Ray moved[MaxRays];
  RayMask sides[8] = {};
  ForEachRay(left,
    [&](int index)
    { sides[MoveAlongAll(space, indexToWorld, rays[index], moved[index])] |= GetBit(index); });
  for (int side = 0; side < 8; ++side)
  {
    if (sides[side] == 0)
    {
      continue;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      packet.Forward[axis] = (side >> axis & 1) != 0;
    }
    kernel.SetRays(packet, moved, sides[side], space, cells);
    if (packet.Rays != 0)
    {
      RayBeam own;
      own.Set(packet);
      BeamBricks bricks = find(own);
      found |= visit(bricks);
    }
  }
  return found;
}

/// A packet in the index space of a lattice: what LevelPackets is for levels.
class LatticePackets
{
public:
  explicit LatticePackets(const LatticeField& field)
    : Field(field)
  {
  }

  RayPacket& GetCoarsest() { return this->Packet; }
  RayPacket& Get(dsm::BlockId) { return this->Packet; }
  const bricks::ValueRange& GetRange(dsm::BlockId id) const
  {
    return this->Field.Voxels->Hierarchy.GetLevels()[0].Ranges[id];
  }
  /// From front to back.
  std::vector<std::size_t> GetOrder(const BeamBricks& bricks) const
  {
    std::vector<std::size_t> order(bricks.Bricks.size());
    std::iota(order.begin(), order.end(), std::size_t{ 0 });
    return order;
  }

private:
  const LatticeField& Field;
  RayPacket Packet;
};

/// FillPackets for a lattice: calls `visit(bricks, packets)` with the bricks whose values satisfy `mayHold`.
template <class Predicate, class Visit>
RayMask ForEachPacket(const LatticeField& field, const Predicate& mayHold,
  const PacketKernel& kernel, BeamBricks* beam, const Ray* rays, RayMask wanted, const Visit& visit)
{
  LatticePackets packets(field);
  const IndexSpace space = field.GetIndexSpace();
  return FillPackets(
    packets.GetCoarsest(), space, field.IndexToWorld, field.Voxels->Lattice.GetCells(), kernel,
    beam, rays, wanted,
    [&](const RayBeam& own) {
      return BeamDescent<Predicate>(field.Voxels->Hierarchy, mayHold, own, space.GetPlanes())
        .Find();
    },
    [&](BeamBricks& bricks) { return visit(bricks, packets); });
}

} // namespace rt

#endif
