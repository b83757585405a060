// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_ExtremumCells_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_ExtremumCells_inl_h
#undef rt_ExtremumCells_inl_h
#else
#define rt_ExtremumCells_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/ray/RayExtrema.h"

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Visitor for rays that look for their largest or smallest value; see CellCrossing. A ray never finds a larger value
/// than the largest of a cell's range, so what has no larger values can be skipped. Skipping depends on the other rays,
/// but the result does not.
template <class D>
class ExtremumCells
{
public:
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  explicit ExtremumCells(RayExtrema& extrema)
    : Extrema(extrema)
  {
  }

  template <class Crossing>
  HWY_INLINE std::uint32_t Visit(const Crossing& cells)
  {
    const D tag;
    Vector least;
    Vector most;
    cells.FindRange(least, most);
    if (this->Extrema.Sign < 0.0)
    {
      most = hn::Neg(least);
    }
    const Vector known = LoadLanes<double, Width>(this->Extrema.Value, cells.Ray);
    const Mask promising = hn::And(cells.Crossing, hn::Gt(most, known));
    if (hn::AllFalse(tag, promising))
    {
      return 0;
    }
    Vector value;
    Vector place;
    cells.GetCubics(hn::Set(tag, this->Extrema.Sign)).FindLargest(value, place);
    value = hn::Min(value, most);
    std::uint32_t better = GetMaskBits(tag, hn::And(promising, hn::Gt(value, known))) & cells.There;
    const std::uint32_t ended =
      better & GetMaskBits(tag, hn::Ge(value, hn::Set(tag, this->Extrema.Goal)));
    HWY_ALIGN double values[Width];
    HWY_ALIGN double places[Width];
    hn::Store(value, tag, values);
    hn::Store(hn::Add(cells.Enter, hn::Mul(place, hn::Sub(cells.Exit, cells.Enter))), tag, places);
    for (; better != 0; better &= better - 1)
    {
      const int lane = __builtin_ctz(better);
      const int ray = static_cast<int>(cells.Ray[lane]);
      this->Extrema.Value[ray] = values[lane];
      this->Extrema.T[ray] = places[lane];
      this->Extrema.Found |= GetBit(ray);
    }
    return ended;
  }

private:
  RayExtrema& Extrema;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
