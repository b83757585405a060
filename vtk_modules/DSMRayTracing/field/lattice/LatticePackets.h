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

namespace rt
{

/// Makes `moved` move along all three axes, as rays of a packet do. A ray that does not, moves so little that it stays at
/// its place for all that can be seen. Returns the sides to which the ray moves, a bit for each axis.
inline int MoveAlongAll(const LatticeField& field, const Ray& ray, Ray& moved)
{
  constexpr double least = 1e-10;
  glm::dvec3 direction = field.GetIndexSpace().GetWorldToIndex() * ray.Direction;
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
    moved.Direction = glm::dmat3(field.IndexToWorld) * direction;
  }
  return side;
}

/// Makes packets of those of a batch of rays that are `wanted`: of rays that move to the same sides, or of a lone ray.
/// Calls `visit(bricks, packet)` for each, with the bricks where `mayHold` says so of their values; it returns some of
/// the rays, as this does. `beam`: with all of the rays within; null, or not usable: the bricks are looked for.
template <class Predicate, class Visit>
RayMask ForEachPacket(const LatticeField& field, const Predicate& mayHold,
  const PacketKernel& kernel, BeamBricks* beam, const Ray* rays, RayMask wanted, const Visit& visit)
{
  RayMask found = 0;
  RayMask left = wanted;
  RayPacket packet;
  const IndexSpace space = field.GetIndexSpace();
  const bricks::Index3 cells = field.Voxels->Lattice.GetCells();
  if (beam && beam->Usable)
  {
    std::copy_n(beam->Forward, 3, packet.Forward);
    left = kernel.SetRays(packet, rays, wanted, space, cells);
    found |= visit(*beam, packet);
  }
  if (left == 0)
  {
    return found;
  }
  Ray moved[MaxRays];
  RayMask sides[8] = {};
  ForEachRay(left,
    [&](int index) { sides[MoveAlongAll(field, rays[index], moved[index])] |= GetBit(index); });
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
      BeamBricks bricks = BeamDescent<Predicate>(field.Voxels->Hierarchy, mayHold, own).Find();
      found |= visit(bricks, packet);
    }
  }
  return found;
}

} // namespace rt

#endif
