// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_MediumCells_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MediumCells_inl_h
#undef rt_MediumCells_inl_h
#else
#define rt_MediumCells_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/cells/CellCrossing-inl.h"
#include "DSMRayTracing/field/cells/MediumPieces-inl.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Visitor for rays through a medium; see CellCrossing. Each cell is a way of MediumPieces.
template <class D>
class MediumCells
{
public:
  using Vector = hn::Vec<D>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  MediumCells(const TransferFunction& function, MediumLight& light)
    : Function(function)
    , Light(light)
    , Pieces(function, light)
  {
  }

  template <class Crossing>
  HWY_INLINE std::uint32_t Visit(const Crossing& cells)
  {
    const D tag;
    const std::uint32_t there = GetMaskBits(tag, cells.Crossing) & cells.There;
    if (there == 0)
    {
      return 0;
    }
    const Vector scale = hn::Set(tag, this->Function.GetScale());
    Vector cubic[4];
    cells.GetCubics().GetCoefficients(cubic);
    const auto evaluate = [&](double s)
    {
      const Vector at = hn::Set(tag, s);
      const Vector inner = hn::Add(cubic[1], hn::Mul(at, hn::Add(cubic[2], hn::Mul(at, cubic[3]))));
      return hn::Mul(scale, hn::Add(cubic[0], hn::Mul(at, inner)));
    };
    const Vector length = hn::Mul(hn::Sub(cells.Exit, cells.Enter),
      SetLanes<double, Width>([&](int lane) { return this->Light.Length[cells.Ray[lane]]; }));
    typename MediumPieces<F>::Ways ways;
    ways.First = hn::DemoteTo(F(), hn::Mul(scale, cubic[0]));
    ways.Middle = hn::DemoteTo(F(), evaluate(0.5));
    ways.Last = hn::DemoteTo(F(), evaluate(1.0));
    ways.Cubic = hn::DemoteTo(F(), hn::Mul(scale, cubic[3]));
    ways.Length = hn::DemoteTo(F(), length);
    ways.Begin = hn::Zero(F());
    ways.End = hn::Set(F(), 1.0f);
    HWY_ALIGN double origin[Width];
    HWY_ALIGN double distance[Width];
    hn::Store(cells.Enter, tag, origin);
    hn::Store(hn::Sub(cells.Exit, cells.Enter), tag, distance);
    this->Pieces.SetRays(cells.Ray, there, origin, distance);
    this->Pieces.Add(ways, GetBitMask(F(), there), this->FindBehavior(cells, there));
    const std::uint32_t dark = GetMaskBits(F(), this->Pieces.FindDark()) & there;
    this->Pieces.PutRays(there);
    return dark;
  }

private:
  using F = hn::Rebind<float, D>;
  using Behavior = typename MediumPieces<F>::Behavior;

  /// In the ranges of the cells of `lanes`.
  template <class Crossing>
  Behavior FindBehavior(const Crossing& cells, std::uint32_t lanes) const
  {
    const D tag;
    const Vector scale = hn::Set(tag, this->Function.GetScale());
    Vector least;
    Vector most;
    cells.FindRange(least, most);
    HWY_ALIGN double first[Width];
    HWY_ALIGN double last[Width];
    hn::Store(hn::Mul(least, scale), tag, first);
    hn::Store(hn::Mul(most, scale), tag, last);
    HWY_ALIGN float changes[Width] = {};
    HWY_ALIGN float depths[Width] = {};
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      const TransferFunction::Behavior found = this->Function.FindBehavior(first[lane], last[lane]);
      changes[lane] = static_cast<float>(found.Change);
      depths[lane] = static_cast<float>(found.Extinction * found.Tinge);
    }
    return { hn::Load(F(), changes), hn::Load(F(), depths) };
  }

  const TransferFunction& Function;
  MediumLight& Light;
  MediumPieces<F> Pieces;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
