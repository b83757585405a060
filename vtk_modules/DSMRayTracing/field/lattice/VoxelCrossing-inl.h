// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_VoxelCrossing_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_VoxelCrossing_inl_h
#undef rt_VoxelCrossing_inl_h
#else
#define rt_VoxelCrossing_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/cells/CellCrossing-inl.h"
#include "DSMRayTracing/field/cells/Cubics-inl.h"
#include "DSMRayTracing/field/lattice/PacketBrick.h"
#include "DSMRayTracing/ray/RayPacket.h"

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// The cubics that trilinear functions are from `start` to `end` in their cells: GetCubic and EvaluateTrilinear of
/// TrilinearCell.h for a vector of rays, with the same operations in the same order.
template <class D>
class TrilinearCubics
{
public:
  using Vector = hn::Vec<D>;

  static Cubics<D> Create(const Vector corners[8], const Vector start[3], const Vector end[3])
  {
    const Vector direction[3] = { hn::Sub(end[0], start[0]), hn::Sub(end[1], start[1]),
      hn::Sub(end[2], start[2]) };
    Vector coefficients[4];
    SetCoefficients(corners, start, direction, coefficients);
    const Vector x00 = Interpolate(corners[0], corners[1], end[0]);
    const Vector x10 = Interpolate(corners[2], corners[3], end[0]);
    const Vector x01 = Interpolate(corners[4], corners[5], end[0]);
    const Vector x11 = Interpolate(corners[6], corners[7], end[0]);
    const Vector last =
      Interpolate(Interpolate(x00, x10, end[1]), Interpolate(x01, x11, end[1]), end[2]);
    return Cubics<D>(coefficients, last);
  }

private:
  static Vector Interpolate(Vector a, Vector b, Vector u)
  {
    return hn::Add(hn::Mul(hn::Sub(hn::Set(D(), 1.0), u), a), hn::Mul(u, b));
  }

  static void SetCoefficients(const Vector corners[8], const Vector start[3],
    const Vector direction[3], Vector coefficients[4])
  {
    Vector linear[4][2];
    for (int edge = 0; edge < 4; ++edge)
    {
      const Vector a = corners[2 * edge];
      const Vector b = corners[2 * edge + 1];
      linear[edge][0] = Interpolate(a, b, start[0]);
      linear[edge][1] = hn::Mul(direction[0], hn::Sub(b, a));
    }
    Vector quadratic[2][3];
    for (int face = 0; face < 2; ++face)
    {
      const Vector* a = linear[2 * face];
      const Vector* b = linear[2 * face + 1];
      quadratic[face][0] = Interpolate(a[0], b[0], start[1]);
      quadratic[face][1] =
        hn::Add(Interpolate(a[1], b[1], start[1]), hn::Mul(direction[1], hn::Sub(b[0], a[0])));
      quadratic[face][2] = hn::Mul(direction[1], hn::Sub(b[1], a[1]));
    }
    const Vector* a = quadratic[0];
    const Vector* b = quadratic[1];
    coefficients[0] = Interpolate(a[0], b[0], start[2]);
    coefficients[1] =
      hn::Add(Interpolate(a[1], b[1], start[2]), hn::Mul(direction[2], hn::Sub(b[0], a[0])));
    coefficients[2] =
      hn::Add(Interpolate(a[2], b[2], start[2]), hn::Mul(direction[2], hn::Sub(b[1], a[1])));
    coefficients[3] = hn::Mul(direction[2], hn::Sub(b[2], a[2]));
  }
};

/// Rays in voxels' cells, where values are trilinear; see CellCrossing.
template <class D>
struct VoxelCrossing : CellCrossing<D>
{
  using Vector = hn::Vec<D>;
  static constexpr int PlaceNumbers = 9;

  Vector Corners[8]; ///< less what the brick subtracts
  Vector Place[3];   ///< cell's position in the brick
  Vector Start[3];   ///< within the cell, in [0, 1]
  Vector End[3];
  const PacketBrick* Brick;
  const bool* Forward;

  Cubics<D> GetCubics() const
  {
    return TrilinearCubics<D>::Create(this->Corners, this->Start, this->End);
  }
  Cubics<D> GetCubics(Vector sign) const
  {
    Vector corners[8];
    for (int corner = 0; corner < 8; ++corner)
    {
      corners[corner] = hn::Mul(this->Corners[corner], sign);
    }
    return TrilinearCubics<D>::Create(corners, this->Start, this->End);
  }

  HWY_INLINE void FindRange(Vector& least, Vector& most) const
  {
    least = this->Corners[0];
    most = this->Corners[0];
    for (int corner = 1; corner < 8; ++corner)
    {
      least = hn::Min(least, this->Corners[corner]);
      most = hn::Max(most, this->Corners[corner]);
    }
  }

  template <class Put>
  HWY_INLINE void PutPlace(const Put& put) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      put(axis, this->Start[axis]);
      put(3 + axis, hn::Sub(this->End[axis], this->Start[axis]));
      put(6 + axis, this->Place[axis]);
    }
  }
  /// Sets the place of hit `first` and those after it at `position` on their ways. `get(number)`: what PutPlace put.
  template <class Get>
  static HWY_INLINE void SetPlace(PacketHits& hits, int first, Vector position, const Get& get)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector local = hn::Add(get(axis), hn::Mul(position, get(3 + axis)));
      hn::Store(ClampToUnit(local), D(), hits.Local[axis] + first);
      hn::Store(get(6 + axis), D(), hits.Cell[axis] + first);
    }
  }

  /// See PacketBrick::LevelBorder.
  HWY_INLINE std::uint32_t FindHidden(const Cubics<D>& cubics, std::uint32_t rays) const
  {
    const D tag;
    const PacketBrick::LevelBorder& border = this->Brick->Border;
    if (border.Sides == 0)
    {
      return 0;
    }
    const auto isNear =
      hn::Le(hn::Abs(cubics.GetLast()), hn::Set(tag, border.Rounding * border.Largest));
    std::uint32_t near = GetMaskBits(tag, hn::And(isNear, this->Crossing)) & rays;
    if (near == 0)
    {
      return 0;
    }
    HWY_ALIGN double values[8 + 3 + 3 + 1][hn::MaxLanes(tag)];
    for (int corner = 0; corner < 8; ++corner)
    {
      hn::Store(this->Corners[corner], tag, values[corner]);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      hn::Store(this->Place[axis], tag, values[8 + axis]);
      hn::Store(this->End[axis], tag, values[11 + axis]);
    }
    hn::Store(cubics.GetLast(), tag, values[14]);
    std::uint32_t hidden = 0;
    for (; near != 0; near &= near - 1)
    {
      const int lane = __builtin_ctz(near);
      double corners[8];
      for (int corner = 0; corner < 8; ++corner)
      {
        corners[corner] = values[corner][lane];
      }
      int cell[3];
      double end[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        cell[axis] = static_cast<int>(values[8 + axis][lane]);
        end[axis] = values[11 + axis][lane];
      }
      const bool isHidden =
        border.MayHide(*this->Brick, corners, cell, end, this->Forward, values[14][lane]);
      hidden |= std::uint32_t{ isHidden } << lane;
    }
    return hidden;
  }
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
