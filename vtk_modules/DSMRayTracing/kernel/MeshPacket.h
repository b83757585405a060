// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshPacket_h
#define rt_MeshPacket_h

#include "DSMRayTracing/kernel/MeshInstance.h"
#include "DSMRayTracing/kernel/NearestTriangle.h"
#include "DSMRayTracing/kernel/RayPacket.h"
#include "DSMRayTracing/kernel/TriangleFilter.h"

namespace rt
{

/// Rays of one mesh that are traced together: what the tests of boxes need, one array for each
/// number (BoxRay). All move in the same direction on each axis, and most along the same one. They
/// have nothing else in common: what one finds does not depend on the others, since boxes only save
/// work, and each ray's triangles are decided on by NearestTriangle.
struct MeshPacket
{
  static constexpr int Size = RayPacket::Size;
  using Mask = RayPacket::Mask;

  alignas(64) float Origin[3][Size];
  alignas(64) float Inverse[3][Size];
  alignas(64) float Margin[3][Size];
  /// Where the rays, or what is left of them, end.
  alignas(64) float Last[Size];

  NearestTriangle Rays[Size];
  /// In the brick that is being searched.
  FilterRay Filters[Size];

  unsigned Heading; ///< MeshRay::Heading of all of them
  MeshCulling Culling;

  /// Along which the rays move most.
  int GetAxis() const { return static_cast<int>(this->Heading & 3u); }
  /// Whether they move towards smaller coordinates.
  bool IsBackward(int axis) const { return (this->Heading >> axis & 4u) != 0; }

  /// Makes the packet of those rays of `wanted` (world space) that may meet the mesh and have in
  /// common what they must. Returns the former; `alone` are those that must be traced one by one.
  Mask SetRays(const MeshInstance& instance, const Ray* rays, Mask wanted, Mask& alone)
  {
    Mask fitting = 0;
    alone = 0;
    this->Culling = instance.Culling;
    for (; wanted != 0; wanted &= wanted - 1)
    {
      const int index = GetLowest(wanted);
      NearestTriangle& ray = this->Rays[index];
      ray.Found = false;
      if (!instance.GetMeshRay(rays[index], ray.Line))
      {
        continue;
      }
      const Mask bit = Mask{ 1 } << index;
      if (fitting == 0)
      {
        this->Heading = ray.Line.Heading;
      }
      (ray.Line.Heading == this->Heading ? fitting : alone) |= bit;
    }
    const int any = fitting != 0 ? GetLowest(fitting) : 0;
    for (int index = 0; index < Size && fitting != 0; ++index)
    {
      // Lanes without a ray do what another does, and are never looked at.
      const MeshRay& line = this->Rays[(fitting >> index & 1) != 0 ? index : any].Line;
      for (int axis = 0; axis < 3; ++axis)
      {
        this->Origin[axis][index] = line.Boxes.Origin[axis];
        this->Inverse[axis][index] = line.Boxes.Inverse[axis];
        this->Margin[axis][index] = line.Boxes.Margin[axis];
      }
      this->Last[index] = line.BoxesEnd;
    }
    return fitting;
  }
};

} // namespace rt

#endif
