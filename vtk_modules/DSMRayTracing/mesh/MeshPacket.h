// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshPacket_h
#define rt_MeshPacket_h

#include "DSMRayTracing/mesh/MeshInstance.h"
#include "DSMRayTracing/mesh/NearestTriangle.h"
#include "DSMRayTracing/mesh/TriangleFilter.h"
#include "DSMRayTracing/ray/RayPacket.h"
#include "DSMRayTracing/ray/ShearedRay.h"

namespace rt
{

/// Rays of one mesh that are traced together: ShearedRay, one array for each number. All move in the
/// same direction on each axis, and most along the same one. They have nothing else in common: what
/// one finds does not depend on the others, since boxes only save work, and each ray's triangles are
/// decided on by NearestTriangle.
struct MeshPacket
{
  static constexpr int Size = 16;
  /// Bit i is ray i.
  using Mask = std::uint32_t;

  // TriangleRay:
  int Axes[3];
  alignas(64) double Origin[3][Size]; ///< along Axes
  alignas(64) double Shear[3][Size];
  alignas(64) double Min[Size];
  alignas(64) double Max[Size];

  // BoxRay:
  bool Backward[3]; ///< true if the rays move towards smaller coordinates
  alignas(64) float Start[3][Size];
  alignas(64) float Inverse[3][Size];
  alignas(64) float Margin[3][Size];

  // ShearedRay:
  alignas(64) float FilterShear[2][Size];
  alignas(64) float BoxesEnd[Size];
  alignas(64) double StartT[Size];
  alignas(64) double BoxesPerT[Size];
  alignas(64) float Uncertainty[Size];

  /// Filters for the brick that is being searched.
  FilterRay Filters[Size];
  NearestTriangle Nearest[Size];
  MeshCulling Culling;

  TriangleRay GetTriangleRay(int index) const
  {
    TriangleRay ray;
    for (int place = 0; place < 3; ++place)
    {
      ray.Axes[place] = this->Axes[place];
      ray.Origin[place] = this->Origin[place][index];
      ray.Shear[place] = this->Shear[place][index];
    }
    ray.Min = this->Min[index];
    ray.Max = this->Max[index];
    return ray;
  }

  void SetFilter(int index, const bricks::TriangleBrick& brick)
  {
    const float start[3] = { this->Start[0][index], this->Start[1][index], this->Start[2][index] };
    const float shear[2] = { this->FilterShear[0][index], this->FilterShear[1][index] };
    this->Filters[index] = FilterRay(start, shear, this->Uncertainty[index], brick);
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
