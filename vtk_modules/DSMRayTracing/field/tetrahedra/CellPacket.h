// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellPacket_h
#define rt_CellPacket_h

#include "DSMRayTracing/field/tetrahedra/CellField.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/ray/ShearedRay.h"

#include <cstddef>

namespace rt
{

/// Rays of a batch through a CellField that move most along the same axis, in the same direction: ShearedRay. A lane
/// has the numbers of one ray. The result of a ray does not depend on the others.
struct CellPacket
{
  static constexpr int Size = MaxRays;

  int Count = 0;
  int Rays[Size]; ///< numbers of the rays in their batch

  /// TriangleRay.
  struct alignas(64) LaneRay
  {
    double Origin[3]; ///< along Axes
    double Min;
    double Shear[3];
    double Max;
  };
  int Axes[3];
  LaneRay Lanes[Size] = {};

  // BoxRay:
  alignas(64) float Start[3][Size] = {};
  alignas(64) float Inverse[3][Size] = {};
  alignas(64) float Margin[3][Size] = {};

  // ShearedRay:
  alignas(64) float FilterShear[2][Size] = {}; ///< along Axes
  alignas(64) float BoxesEnd[Size] = {};
  alignas(64) float Uncertainty[Size] = {};
  alignas(64) double StartT[Size] = {};
  alignas(64) double BoxesPerT[Size] = {};

  /// Bits of all lanes that have a ray.
  RayMask GetLanes() const { return ~RayMask{ 0 } >> (Size - this->Count); }

  /// Adds the ray of a number. The first one decides on Axes.
  void Add(int number, const ShearedRay& ray)
  {
    const int lane = this->Count++;
    this->Rays[lane] = number;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Axes[axis] = ray.Triangles.Axes[axis];
      this->Lanes[lane].Origin[axis] = ray.Triangles.Origin[axis];
      this->Lanes[lane].Shear[axis] = ray.Triangles.Shear[axis];
      this->Start[axis][lane] = ray.Boxes.Origin[axis];
      this->Inverse[axis][lane] = ray.Boxes.Inverse[axis];
      this->Margin[axis][lane] = ray.Boxes.Margin[axis];
    }
    this->Lanes[lane].Min = ray.Triangles.Min;
    this->Lanes[lane].Max = ray.Triangles.Max;
    this->FilterShear[0][lane] = static_cast<float>(ray.Triangles.Shear[0]);
    this->FilterShear[1][lane] = static_cast<float>(ray.Triangles.Shear[1]);
    this->BoxesEnd[lane] = ray.BoxesEnd;
    this->Uncertainty[lane] = ray.Uncertainty;
    this->StartT[lane] = ray.StartT;
    this->BoxesPerT[lane] = ray.BoxesPerT;
  }

  /// Ends the ray of a lane at `t`: boxes behind it need not be visited.
  void Shorten(int lane, double t)
  {
    this->Lanes[lane].Max = t;
    this->BoxesEnd[lane] =
      ShearedRay::GetBoxesT(t, this->StartT[lane], this->BoxesPerT[lane], this->Uncertainty[lane]);
  }
  ///@{
  /// Nothing need be visited any more.
  void End(int lane) { this->BoxesEnd[lane] = ShearedRay::NoBoxes; }
  bool IsOpen(int lane) const { return this->BoxesEnd[lane] != ShearedRay::NoBoxes; }
  /// Numbers of the rays, as bits.
  RayMask GetOpenRays() const
  {
    RayMask open = 0;
    for (int lane = 0; lane < this->Count; ++lane)
    {
      open |= GetBit(this->Rays[lane], this->IsOpen(lane));
    }
    return open;
  }
  ///@}
};

/// Calls `visit(packet)` for packets that have all of the `wanted` rays (world space) that may meet a field.
template <class Visit>
inline void ForEachPacket(
  const CellField& field, const Ray* rays, RayMask wanted, const Visit& visit)
{
  if (field.Voxels->Hierarchy.IsEmpty())
  {
    return;
  }
  const bricks::CellBricks& cells = *field.Voxels->Cells;
  const glm::dmat3 toIndex(field.WorldToIndex);
  ShearedRay there[MaxRays];
  RayMask left = FindRays(wanted,
    [&](int number)
    {
      const Ray& ray = rays[number];
      const glm::dvec3 origin = field.ToIndex(ray.Origin);
      const glm::dvec3 direction = toIndex * ray.Direction;
      return there[number].Set(
        &origin.x, &direction.x, ray.Min, ray.Max, &cells.Lower.x, &cells.Upper.x);
    });
  while (left != 0)
  {
    const TriangleRay& first = there[GetLowest(left)].Triangles;
    CellPacket packet;
    const RayMask alike = FindRays(left,
      [&](int number)
      {
        const TriangleRay& ray = there[number].Triangles;
        return ray.Axes[2] == first.Axes[2] && ray.Axes[0] == first.Axes[0];
      });
    ForEachRay(alike, [&](int number) { packet.Add(number, there[number]); });
    visit(packet);
    left &= ~alike;
  }
}

} // namespace rt

#endif
