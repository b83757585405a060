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
  {
  }

  HWY_INLINE std::uint32_t Visit(const CrossedCells<D>& cells)
  {
    const D tag;
    std::uint32_t left = GetMaskBits(tag, cells.Crossing) & cells.There;
    const Vector scale = hn::Set(tag, this->Function.GetScale());
    const Vector length = hn::Mul(hn::Sub(cells.Exit, cells.Enter),
      SetLanes<double, Width>([&](int lane) { return this->Light.Length[cells.Ray[lane]]; }));
    Vector cubic[4];
    PacketCrossing<D>(tag, cells.Corners, cells.Start, cells.End).GetCoefficients(cubic);
    for (Vector& coefficient : cubic)
    {
      coefficient = hn::Mul(coefficient, scale);
    }
    HWY_ALIGN double inverse[Width];
    const int most = this->CountPieces(cells, cubic, length, left, inverse);
    if (left == 0)
    {
      return 0;
    }
    Piece pieces(*this, cells, hn::Mul(length, hn::Load(tag, inverse)), inverse);
    std::uint32_t ended = 0;
    for (int number = 0; number <= most && left != 0; ++number)
    {
      // The last one is the cell's end, whatever rounding does.
      const Vector way = hn::Min(hn::Set(tag, 1.0),
        hn::Mul(hn::Set(tag, static_cast<double>(number)), hn::Load(tag, inverse)));
      const Vector inner = hn::Add(cubic[2], hn::Mul(way, cubic[3]));
      const Vector place = hn::Add(cubic[0], hn::Mul(way, hn::Add(cubic[1], hn::Mul(way, inner))));
      ended |= pieces.Add(number, place, left);
      left &= ~ended;
    }
    return ended;
  }

private:
  static constexpr double MostPieces = 64.0;
  /// Of optical depth, in a cell.
  static constexpr double Tolerance = 1.0 / 2048.0;

  /// The pieces that a cell is cut into: their parts of the whole. Takes those lanes out of `left` that see nothing.
  /// Returns the largest number.
  HWY_INLINE int CountPieces(const CrossedCells<D>& cells, const Vector cubic[4], Vector length,
    std::uint32_t& left, double* inverse) const
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
    HWY_ALIGN double bend[Width];
    HWY_ALIGN double lengths[Width];
    hn::Store(hn::Mul(least, scale), tag, first);
    hn::Store(hn::Mul(largest, scale), tag, last);
    const Vector two = hn::Set(tag, 2.0);
    const Vector atBegin = hn::Mul(two, cubic[2]);
    const Vector atEnd = hn::Add(atBegin, hn::Mul(hn::Set(tag, 6.0), cubic[3]));
    hn::Store(hn::Max(hn::Abs(atBegin), hn::Abs(atEnd)), tag, bend);
    hn::Store(length, tag, lengths);
    double most = 0.0;
    const std::uint32_t asked = left;
    for (int lane = 0; lane < Width; ++lane)
    {
      inverse[lane] = 1.0;
      if ((asked >> lane & 1u) == 0)
      {
        continue;
      }
      const TransferFunction::Behavior behavior =
        this->Function.FindBehavior(first[lane], last[lane]);
      if (behavior.Extinction == 0.0)
      {
        left &= ~(1u << lane);
        continue;
      }
      const double curved =
        std::sqrt(lengths[lane] * behavior.Change * bend[lane] * (0.125 / Tolerance));
      const double deep = 4.0 * lengths[lane] * behavior.Extinction;
      const double pieces = std::ceil(std::clamp(std::max(curved, deep), 1.0, MostPieces));
      inverse[lane] = 1.0 / pieces;
      most = std::max(most, pieces);
    }
    return static_cast<int>(most);
  }

  /// Where rays are in the cells, and what they have met there so far.
  class Piece
  {
  public:
    HWY_INLINE Piece(
      MediumCells& whole, const CrossedCells<D>& cells, Vector length, const double* inverse)
      : Whole(whole)
      , Cells(cells)
      , Inverse(inverse)
    {
      const D tag;
      hn::Store(length, tag, this->Length);
    }

    /// Goes on to the place, in bins, where piece `number` ends, which no lane does that has fewer. Returns the lanes
    /// that are dark.
    HWY_INLINE std::uint32_t Add(int number, Vector place, std::uint32_t lanes)
    {
      const D tag;
      HWY_ALIGN double places[Width];
      HWY_ALIGN double depths[Width];
      hn::Store(place, tag, places);
      hn::Store(hn::Zero(tag), tag, depths);
      std::uint32_t some = 0;
      for (std::uint32_t left = lanes; left != 0; left &= left - 1)
      {
        const int lane = __builtin_ctz(left);
        const double pieceOfLane = static_cast<double>(number - 1) * this->Inverse[lane];
        if (pieceOfLane > 1.0 - 1e-9)
        {
          continue;
        }
        Lanes slope;
        const Lanes integral = this->Whole.Function.Integrate(places[lane], slope);
        if (number > 0)
        {
          const double way = places[lane] - this->Place[lane];
          const Lanes mean =
            std::abs(way) > ShortWay ? (integral - this->Integral[lane]) * Lanes(1.0 / way) : slope;
          this->Amount[lane] = mean * Lanes(this->Length[lane]);
          depths[lane] = this->Amount[lane][3];
          some |= std::uint32_t{ depths[lane] > 0.0 } << lane;
        }
        this->Place[lane] = places[lane];
        this->Integral[lane] = integral;
      }
      return some == 0 ? 0 : this->Pass(number, some, hn::Load(tag, depths));
    }

  private:
    /// In bins: on a shorter way, the function is nearly constant, and differences would be rounding.
    static constexpr double ShortWay = 1e-7;

    HWY_INLINE std::uint32_t Pass(int number, std::uint32_t lanes, Vector depth)
    {
      const D tag;
      const Vector one = hn::Set(tag, 1.0);
      const Vector passed = GetTransmittance(depth);
      // (1 - exp(-depth)) / depth
      const Vector thin = hn::Sub(one, hn::Mul(hn::Set(tag, 0.5), depth));
      const Vector seen = hn::IfThenElse(
        hn::Lt(depth, hn::Set(tag, MediumLight::Thin)), thin, hn::Div(hn::Sub(one, passed), depth));
      HWY_ALIGN double passes[Width];
      HWY_ALIGN double parts[Width];
      HWY_ALIGN double enter[Width];
      HWY_ALIGN double exit[Width];
      hn::Store(passed, tag, passes);
      hn::Store(seen, tag, parts);
      hn::Store(this->Cells.Enter, tag, enter);
      hn::Store(this->Cells.Exit, tag, exit);
      MediumLight& light = this->Whole.Light;
      std::uint32_t ended = 0;
      for (; lanes != 0; lanes &= lanes - 1)
      {
        const int lane = __builtin_ctz(lanes);
        const int ray = static_cast<int>(this->Cells.Ray[lane]);
        const Lanes& amount = this->Amount[lane];
        const auto getT = [&](int end)
        { return enter[lane] + (exit[lane] - enter[lane]) * (end * this->Inverse[lane]); };
        light.Add(ray,
          { getT(number - 1), getT(number), { amount[0], amount[1], amount[2], amount[3] } },
          passes[lane], parts[lane]);
        ended |= std::uint32_t{ light.IsDark(ray) } << lane;
      }
      return ended;
    }

    MediumCells& Whole;
    const CrossedCells<D>& Cells;
    const double* Inverse;
    HWY_ALIGN double Length[Width]; ///< world, of a piece
    HWY_ALIGN double Place[Width];  ///< where the last piece ends
    Lanes Integral[Width];
    Lanes Amount[Width]; ///< of the current piece
  };

  const TransferFunction& Function;
  MediumLight& Light;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
