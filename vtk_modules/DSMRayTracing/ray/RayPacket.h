// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_RayPacket_h
#define rt_RayPacket_h

#include "DSMRayTracing/ray/CellHit.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <cstdint>

namespace bricks
{
class GridPlanes;
}

namespace rt
{

/// Rays of one volume that are traced together, in its index space: GridRay, one array for each
/// number. All move along all three axes, in the same direction on each, so that any order of boxes
/// that is front to back for one of them is so for all. They have nothing else in common: what one
/// finds does not depend on the others.
struct RayPacket
{
  static constexpr int Size = MaxRays;
  using Mask = RayMask;

  alignas(64) double Origin[3][Size];
  alignas(64) double Direction[3][Size];
  alignas(64) double Inverse[3][Size];
  /// T at which the ray enters and leaves the volume.
  alignas(64) double Enter[Size];
  alignas(64) double Leave[Size];
  /// The same for the brick that the ray was last tested with.
  alignas(64) double BrickEnter[Size];
  alignas(64) double BrickLeave[Size];
  /// True for each axis along which the rays move towards larger coordinates.
  bool Forward[3];
  /// Planes between the cells of a rectilinear grid, in whose grid space the rays are then; null: at whole numbers.
  const bricks::GridPlanes* Planes = nullptr;
  /// Valid rays; the numbers of the others are undefined.
  Mask Rays = 0;
};

/// Intersections of a packet's rays with an isosurface within a brick, in any order; see CellHit.
struct PacketHits
{
  int Count = 0;
  int Ray[RayPacket::Size];
  alignas(64) double T[RayPacket::Size];
  alignas(64) double Cell[3][RayPacket::Size];  ///< position in the brick; integers
  alignas(64) double Local[3][RayPacket::Size]; ///< within the cell, in [0, 1]
  std::uint64_t FromInside = 0;                 ///< bit i is hit i

  CellHit Get(int index) const
  {
    CellHit hit;
    hit.T = this->T[index];
    hit.FromInside = (this->FromInside >> index & 1u) != 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      hit.Cell[axis] = static_cast<int>(this->Cell[axis][index]);
      hit.Local.Set(axis, this->Local[axis][index]);
    }
    return hit;
  }
};

} // namespace rt

#endif
