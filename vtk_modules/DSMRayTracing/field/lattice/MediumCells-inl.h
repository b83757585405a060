// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_MediumCells_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MediumCells_inl_h
#undef rt_MediumCells_inl_h
#else
#define rt_MediumCells_inl_h
#endif

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/field/lattice/BrickSearch-inl.h"
#include "DSMRayTracing/field/lattice/PacketCrossing-inl.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// exp(-depth) of numbers that are not negative, to 1e-13; the same bits for vectors of any width.
template <class Vector>
HWY_INLINE Vector GetTransmittance(Vector depth)
{
  const hn::DFromV<Vector> tag;
  const hn::RebindToUnsigned<decltype(tag)> bits;
  const Vector bounded = hn::Min(depth, hn::Set(tag, 700.0));
  // The power of two, and what is left: between -ln(2) / 2 and ln(2) / 2.
  const Vector large = hn::Set(tag, 6755399441055744.0);
  const Vector raised = hn::Sub(large, hn::Mul(bounded, hn::Set(tag, 1.4426950408889634)));
  const Vector power = hn::Sub(raised, large);
  const Vector high = hn::Mul(power, hn::Set(tag, 0.693147180369123816490));
  const Vector low = hn::Mul(power, hn::Set(tag, 1.90821492927058770002e-10));
  const Vector rest = hn::Sub(hn::Sub(hn::Neg(bounded), high), low);
  constexpr double factors[] = { 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880,
    1.0 / 40320, 1.0 / 5040, 1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5, 1.0, 1.0 };
  Vector sum = hn::Set(tag, factors[0]);
  for (std::size_t order = 1; order < std::size(factors); ++order)
  {
    sum = hn::Add(hn::Mul(sum, rest), hn::Set(tag, factors[order]));
  }
  // The whole number stands in the lowest bits of `raised`.
  const auto exponent =
    hn::ShiftLeft<52>(hn::Add(hn::BitCast(bits, raised), hn::Set(bits, std::uint64_t{ 1023 })));
  return hn::Mul(sum, hn::BitCast(tag, exponent));
}

/// Of BrickSearch, for rays through a medium. Within a cell, the value along a ray is a cubic. It is cut into so many
/// pieces that it is nearly linear in each, as far as the transfer function makes a difference, and each piece is
/// integrated over its values.
template <class D>
class MediumCells
{
public:
  using Vector = hn::Vec<D>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  MediumCells(const TransferFunction& function, MediumLight& light)
    : Function(function)
    , Light(light)
    , Everywhere(function.GetBehavior())
  {
  }

  HWY_INLINE std::uint32_t Visit(const CrossedCells<D>& cells)
  {
    const D tag;
    std::uint32_t left = GetMaskBits(tag, cells.Crossing) & cells.There;
    if (left == 0)
    {
      return 0;
    }
    const Vector scale = hn::Set(tag, this->Function.GetScale());
    const Vector length = hn::Mul(hn::Sub(cells.Exit, cells.Enter),
      SetLanes<double, Width>([&](int lane) { return this->Light.Length[cells.Ray[lane]]; }));
    Vector cubic[4];
    PacketCrossing<D>(tag, cells.Corners, cells.Start, cells.End).GetCoefficients(cubic);
    for (Vector& coefficient : cubic)
    {
      coefficient = hn::Mul(coefficient, scale);
    }
    Pieces pieces;
    const Vector two = hn::Set(tag, 2.0);
    const Vector atBegin = hn::Mul(two, cubic[2]);
    const Vector atEnd = hn::Add(atBegin, hn::Mul(hn::Set(tag, 6.0), cubic[3]));
    const Vector bend = hn::Max(hn::Abs(atBegin), hn::Abs(atEnd));
    int most = 1;
    if (this->IsOneEnough(bend, length))
    {
      std::fill_n(pieces.Part, Width, 1.0);
    }
    else
    {
      most = this->Count(cells, bend, length, left, pieces);
    }
    const Vector part = hn::Load(tag, pieces.Part);
    hn::Store(hn::Mul(length, part), tag, pieces.Length);
    HWY_ALIGN double places[Width];
    hn::Store(cubic[0], tag, places);
    for (std::uint32_t lanes = left; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      Lanes slope;
      pieces.Place[lane] = places[lane];
      pieces.Integral[lane] = this->Function.Integrate(places[lane], slope);
    }
    std::uint32_t ended = 0;
    for (int number = 1; number <= most && left != 0; ++number)
    {
      // The last one is the cell's end, whatever rounding does.
      const Vector way =
        hn::Min(hn::Set(tag, 1.0), hn::Mul(hn::Set(tag, static_cast<double>(number)), part));
      const Vector inner = hn::Add(cubic[2], hn::Mul(way, cubic[3]));
      hn::Store(
        hn::Add(cubic[0], hn::Mul(way, hn::Add(cubic[1], hn::Mul(way, inner)))), tag, places);
      ended |= this->Add(cells, number, places, left, pieces);
      left &= ~ended;
    }
    return ended;
  }

private:
  static constexpr double MostPieces = 64.0;
  /// Of optical depth, in a cell.
  static constexpr double Tolerance = 1.0 / 2048.0;
  static constexpr double BendFactor = 0.125 / Tolerance;
  /// Pieces for a unit of optical depth: colors change within.
  static constexpr double DepthFactor = 4.0;
  /// In bins: on a shorter way, the function is nearly constant, and differences would be rounding.
  static constexpr double ShortWay = 1e-7;

  /// The pieces that the cells are cut into, and where rays are in them.
  struct Pieces
  {
    HWY_ALIGN double Part[Width];   ///< of a piece, of the whole
    HWY_ALIGN double Length[Width]; ///< world, of a piece
    HWY_ALIGN double Place[Width];  ///< in bins: where the last piece ended
    Lanes Integral[Width];          ///< of the function up to there
  };

  /// Whether all cells are one piece, whatever values are in them.
  HWY_INLINE bool IsOneEnough(Vector bend, Vector length) const
  {
    const D tag;
    const Vector curved =
      hn::Mul(hn::Mul(length, bend), hn::Set(tag, this->Everywhere.Change * BendFactor));
    const Vector deep = hn::Mul(length, hn::Set(tag, this->Everywhere.Extinction * DepthFactor));
    return hn::AllTrue(tag, hn::Le(hn::Max(curved, deep), hn::Set(tag, 1.0)));
  }

  /// Of those of `lanes`. Returns the largest number.
  HWY_INLINE int Count(const CrossedCells<D>& cells, Vector bend, Vector length,
    std::uint32_t lanes, Pieces& pieces) const
  {
    const D tag;
    Vector least = cells.Corners[0];
    Vector largest = cells.Corners[0];
    for (int corner = 1; corner < 8; ++corner)
    {
      least = hn::Min(least, cells.Corners[corner]);
      largest = hn::Max(largest, cells.Corners[corner]);
    }
    const Vector scale = hn::Set(tag, this->Function.GetScale());
    HWY_ALIGN double first[Width];
    HWY_ALIGN double last[Width];
    HWY_ALIGN double bends[Width];
    HWY_ALIGN double lengths[Width];
    hn::Store(hn::Mul(least, scale), tag, first);
    hn::Store(hn::Mul(largest, scale), tag, last);
    hn::Store(bend, tag, bends);
    hn::Store(length, tag, lengths);
    double most = 0.0;
    for (int lane = 0; lane < Width; ++lane)
    {
      pieces.Part[lane] = 1.0;
      if ((lanes >> lane & 1u) == 0)
      {
        continue;
      }
      const TransferFunction::Behavior behavior =
        this->Function.FindBehavior(first[lane], last[lane]);
      // In IsOneEnough's order: what is one piece there is so here, too, whatever other lanes are.
      const double curved = std::sqrt(lengths[lane] * bends[lane] * (behavior.Change * BendFactor));
      const double deep = lengths[lane] * (behavior.Extinction * DepthFactor);
      const double count = std::ceil(std::clamp(std::max(curved, deep), 1.0, MostPieces));
      pieces.Part[lane] = 1.0 / count;
      most = std::max(most, count);
    }
    return static_cast<int>(most);
  }

  /// Goes on to the places, in bins, where piece `number` ends, for those of `lanes` that have as many. Returns those
  /// that are dark.
  HWY_INLINE std::uint32_t Add(const CrossedCells<D>& cells, int number, const double* places,
    std::uint32_t lanes, Pieces& pieces)
  {
    const D tag;
    Lanes amounts[Width];
    HWY_ALIGN double depths[Width];
    hn::Store(hn::Zero(tag), tag, depths);
    std::uint32_t some = 0;
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      if (static_cast<double>(number - 1) * pieces.Part[lane] > 1.0 - 1e-9)
      {
        continue;
      }
      Lanes slope;
      const Lanes integral = this->Function.Integrate(places[lane], slope);
      const double way = places[lane] - pieces.Place[lane];
      const Lanes mean =
        std::abs(way) > ShortWay ? (integral - pieces.Integral[lane]) * Lanes(1.0 / way) : slope;
      amounts[lane] = mean * Lanes(pieces.Length[lane]);
      depths[lane] = amounts[lane].High[1];
      some |= std::uint32_t{ depths[lane] > 0.0 } << lane;
      pieces.Place[lane] = places[lane];
      pieces.Integral[lane] = integral;
    }
    if (some == 0)
    {
      return 0;
    }
    const Vector one = hn::Set(tag, 1.0);
    const Vector depth = hn::Load(tag, depths);
    const Vector passed = GetTransmittance(depth);
    // (1 - exp(-depth)) / depth
    const Vector thin = hn::Sub(one, hn::Mul(hn::Set(tag, 0.5), depth));
    const Vector seen = hn::IfThenElse(
      hn::Lt(depth, hn::Set(tag, MediumLight::Thin)), thin, hn::Div(hn::Sub(one, passed), depth));
    HWY_ALIGN double passes[Width];
    HWY_ALIGN double parts[Width];
    hn::Store(passed, tag, passes);
    hn::Store(seen, tag, parts);
    HWY_ALIGN double enter[Width];
    HWY_ALIGN double exit[Width];
    hn::Store(cells.Enter, tag, enter);
    hn::Store(cells.Exit, tag, exit);
    std::uint32_t ended = 0;
    for (; some != 0; some &= some - 1)
    {
      const int lane = __builtin_ctz(some);
      const int ray = static_cast<int>(cells.Ray[lane]);
      const auto getT = [&](int end)
      { return enter[lane] + (exit[lane] - enter[lane]) * (end * pieces.Part[lane]); };
      if (this->Light.KeepsPieces)
      {
        this->Light.Keep(ray, getT(number - 1), getT(number), amounts[lane], passes[lane]);
      }
      // The first one that a ray meets.
      if (!(this->Light.First[ray] < enter[lane]))
      {
        this->Light.First[ray] = std::min(this->Light.First[ray], getT(number - 1));
      }
      this->Light.Blend(ray, amounts[lane], passes[lane], parts[lane]);
      ended |= std::uint32_t{ this->Light.IsDark(ray) } << lane;
    }
    return ended;
  }

  const TransferFunction& Function;
  MediumLight& Light;
  const TransferFunction::Behavior Everywhere;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
