// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshPacket_h
#define rt_MeshPacket_h

#include "DSMRayTracing/mesh/MeshInstance.h"
#include "DSMRayTracing/mesh/NearestTriangle.h"
#include "DSMRayTracing/mesh/TriangleFilter.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/ray/ShearedRay.h"

namespace rt
{

/// Rays of one mesh that are traced together: ShearedRay, one array for each number. They need have nothing in common.
/// A hit does not depend on the other rays, since boxes only save work, and each ray's triangles are decided on by
/// NearestTriangle.
struct MeshPacket
{
  static constexpr int Size = MaxRays;
  using Mask = RayMask;
  /// The rays that vectors hold at most.
  static constexpr int Block = 16;

  /// The rays that move most along an axis, and those that move towards smaller coordinates.
  Mask Along[3];
  Mask Backward[3];

  // TriangleRay:
  alignas(64) double Origin[3][Size]; ///< along the ray's own axes, as Shear
  alignas(64) double Shear[3][Size];
  alignas(64) double Min[Size];
  alignas(64) double Max[Size];

  // BoxRay:
  alignas(64) float Start[3][Size];
  alignas(64) float Inverse[3][Size];
  alignas(64) float Margin[3][Size];

  // ShearedRay:
  alignas(64) float FilterShear[2][Size];
  alignas(64) float BoxesEnd[Size] = {};
  alignas(64) double StartT[Size];
  alignas(64) double BoxesPerT[Size];
  alignas(64) float Uncertainty[Size] = {};

  /// FilterRay::Error for the brick that is being searched.
  alignas(64) float FilterError[Size];
  NearestTriangle Nearest[Size];
  MeshCulling Culling;

  bool IsBackward(int index, int axis) const { return (this->Backward[axis] >> index & 1) != 0; }
  /// The axis along which a ray moves most.
  int GetAxis(int index) const
  {
    return static_cast<int>((this->Along[1] >> index & 1) + 2 * (this->Along[2] >> index & 1));
  }

  TriangleRay GetTriangleRay(int index) const
  {
    TriangleRay ray;
    const int axis = this->GetAxis(index);
    ray.SetAxes(axis, this->IsBackward(index, axis));
    for (int place = 0; place < 3; ++place)
    {
      ray.Origin[place] = this->Origin[place][index];
      ray.Shear[place] = this->Shear[place][index];
    }
    ray.Min = this->Min[index];
    ray.Max = this->Max[index];
    return ray;
  }

  FilterRay GetFilterRay(int index) const
  {
    return { { this->Start[0][index], this->Start[1][index], this->Start[2][index] },
      { this->FilterShear[0][index], this->FilterShear[1][index] }, this->FilterError[index] };
  }

  void End(int index) { this->BoxesEnd[index] = ShearedRay::NoBoxes; }
  void Shorten(int index, double t)
  {
    this->Max[index] = t;
    this->BoxesEnd[index] = ShearedRay::GetBoxesT(
      t, this->StartT[index], this->BoxesPerT[index], this->Uncertainty[index]);
  }
};

} // namespace rt

#endif
