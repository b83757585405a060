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
#include "DSMRayTracing/field/MediumTolerance.h"
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

/// Emission and extinction, as Lanes has them, in vectors that are as wide as the processor's.
class Row
{
public:
  using Tag = hn::CappedTag<double, 4>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int Parts = 4 / Width;

  Row() = default;
  HWY_INLINE explicit Row(double all)
  {
    for (auto& part : this->Part)
    {
      part = hn::Set(Tag(), all);
    }
  }
  HWY_INLINE explicit Row(const Lanes& lanes)
  {
    for (int part = 0; part < Parts; ++part)
    {
      this->Part[part] = hn::LoadU(Tag(), reinterpret_cast<const double*>(&lanes) + part * Width);
    }
  }
  HWY_INLINE void Store(Lanes& lanes) const
  {
    for (int part = 0; part < Parts; ++part)
    {
      hn::StoreU(this->Part[part], Tag(), reinterpret_cast<double*>(&lanes) + part * Width);
    }
  }

  friend HWY_INLINE Row operator+(const Row& a, const Row& b)
  {
    Row sum;
    for (int part = 0; part < Parts; ++part)
    {
      sum.Part[part] = hn::Add(a.Part[part], b.Part[part]);
    }
    return sum;
  }
  friend HWY_INLINE Row operator-(const Row& a, const Row& b)
  {
    Row difference;
    for (int part = 0; part < Parts; ++part)
    {
      difference.Part[part] = hn::Sub(a.Part[part], b.Part[part]);
    }
    return difference;
  }
  friend HWY_INLINE Row operator*(const Row& a, const Row& b)
  {
    Row product;
    for (int part = 0; part < Parts; ++part)
    {
      product.Part[part] = hn::Mul(a.Part[part], b.Part[part]);
    }
    return product;
  }

private:
  hn::Vec<Tag> Part[Parts];
};

/// Visitor for BrickSearch, for rays through a medium. Within a cell, the value along a ray is a cubic. It is
/// divided into enough pieces that it is nearly linear in each, as far as the transfer function makes a difference;
/// each piece is integrated over its values. A macrocell in which values hardly bend is integrated in one step.
template <class D>
class MediumCells
{
public:
  static constexpr bool TakesMacrocells = true;
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  MediumCells(const TransferFunction& function, MediumLight& light)
    : Function(function)
    , Table(function.GetTable())
    , Light(light)
  {
  }

  HWY_INLINE std::uint32_t Visit(const CrossedCells<D>& cells)
  {
    const D tag;
    const std::uint32_t left = GetMaskBits(tag, cells.Crossing) & cells.There;
    if (left == 0)
    {
      return 0;
    }
    Pieces pieces;
    PacketCrossing<D>(tag, cells.Corners, cells.Start, cells.End).GetCoefficients(pieces.Cubic);
    return this->Go(cells, left, pieces,
      [&](std::uint32_t lanes, MediumBehavior<D>& behavior)
      { this->FindBehavior(cells.Corners, lanes, behavior); });
  }

  HWY_INLINE std::uint32_t Pass(const PassedMacrocells<D>& passed)
  {
    const D tag;
    const std::uint32_t left = GetMaskBits(tag, hn::Lt(passed.Enter, passed.Exit)) & passed.There;
    if (left == 0)
    {
      return 0;
    }
    const Vector two = hn::Set(tag, 2.0);
    const Vector bend =
      hn::Mul(two, hn::Sub(hn::Add(passed.First, passed.Last), hn::Mul(two, passed.Middle)));
    Pieces pieces;
    pieces.Cubic[0] = passed.First;
    pieces.Cubic[1] = hn::Sub(hn::Sub(passed.Last, passed.First), bend);
    pieces.Cubic[2] = bend;
    pieces.Cubic[3] = hn::Zero(tag);
    return this->Go(passed, left, pieces, [](std::uint32_t, MediumBehavior<D>&) {});
  }

private:
  static constexpr double MostPieces = 64.0;
  static constexpr double BendFactor = 0.125 / MediumTolerance::Depth;
  static constexpr double ColorFactor = 1.0 / (12.0 * MediumTolerance::Color);
  static constexpr double ShortWay = MediumTolerance::ShortWay;

  /// The pieces that ways are cut into, and where rays are on them.
  struct Pieces
  {
    Vector Cubic[4];       ///< values: of the way, from 0 to 1
    Vector Part;           ///< share of the whole that one piece has
    Vector Length;         ///< world, of a piece
    Vector Place;          ///< in bins: where the last piece ended
    Lanes Integral[Width]; ///< integral of the function up to Place
  };

  /// Bins of places, and the ways in them.
  struct Located
  {
    HWY_ALIGN std::uint64_t Number[Width];
    HWY_ALIGN double Way[Width];

    HWY_INLINE Located(Vector places, int bins)
    {
      const D tag;
      const Vector one = hn::Set(tag, 1.0);
      const Vector last = hn::Set(tag, bins - 1.0);
      const Vector number = hn::Floor(hn::Min(hn::Max(hn::Add(places, one), hn::Zero(tag)), last));
      hn::Store(ToNumbers(number), hn::RebindToUnsigned<D>(), this->Number);
      hn::Store(hn::Sub(places, hn::Sub(number, one)), tag, this->Way);
    }
  };

  /// Takes those of `left` through cells or macrocells. `refine(lanes, behavior)`: of those lanes, more exactly.
  /// Returns those that are dark then.
  template <class Crossed, class Refine>
  HWY_INLINE std::uint32_t Go(
    const Crossed& crossed, std::uint32_t left, Pieces& pieces, const Refine& refine)
  {
    const D tag;
    const Vector one = hn::Set(tag, 1.0);
    const Vector scale = hn::Set(tag, this->Function.GetScale());
    for (Vector& coefficient : pieces.Cubic)
    {
      coefficient = hn::Mul(coefficient, scale);
    }
    const Vector length = hn::Mul(hn::Sub(crossed.Exit, crossed.Enter),
      SetLanes<double, Width>([&](int lane) { return this->Light.Length[crossed.Ray[lane]]; }));
    const Vector atBegin = hn::Mul(hn::Set(tag, 2.0), pieces.Cubic[2]);
    const Vector atEnd = hn::Add(atBegin, hn::Mul(hn::Set(tag, 6.0), pieces.Cubic[3]));
    const Vector bend = hn::Max(hn::Abs(atBegin), hn::Abs(atEnd));
    const Vector range = hn::Add(
      hn::Abs(pieces.Cubic[1]), hn::Add(hn::Abs(pieces.Cubic[2]), hn::Abs(pieces.Cubic[3])));
    MediumBehavior<D> behavior = crossed.Behavior;
    Vector count = GetCount(length, bend, range, behavior);
    const std::uint32_t several = GetMaskBits(tag, hn::Gt(count, one)) & left;
    if (several != 0)
    {
      refine(several, behavior);
      count = GetCount(length, bend, range, behavior);
    }
    if (this->Light.JoinedLength > 0.0)
    {
      // Pieces are described one by one, and light changes along the way.
      const Vector parts = hn::Mul(length,
        hn::Max(hn::Set(tag, 1.0 / this->Light.JoinedLength),
          hn::Mul(behavior.Extinction, hn::Set(tag, MediumTolerance::DescribedPieces))));
      count = hn::Max(count, hn::Min(hn::Ceil(parts), hn::Set(tag, MostPieces)));
    }
    HWY_ALIGN double counts[Width];
    hn::Store(count, tag, counts);
    int most = 1;
    for (std::uint32_t lanes = left; lanes != 0; lanes &= lanes - 1)
    {
      most = std::max(most, static_cast<int>(counts[__builtin_ctz(lanes)]));
    }
    pieces.Part = hn::Div(one, count);
    pieces.Length = hn::Mul(length, pieces.Part);
    pieces.Place = pieces.Cubic[0];
    const Located begin(pieces.Place, this->Function.GetTableSize());
    for (std::uint32_t lanes = left; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      this->Integrate(begin, lane).Store(pieces.Integral[lane]);
    }
    std::uint32_t ended = 0;
    for (int number = 1; number <= most && left != 0; ++number)
    {
      ended |= this->Add(crossed, number, left, pieces);
      left &= ~ended;
    }
    return ended;
  }

  /// Returns the number of pieces. `range`: extent of the values, in bins.
  static HWY_INLINE Vector GetCount(
    Vector length, Vector bend, Vector range, const MediumBehavior<D>& behavior)
  {
    const D tag;
    const Vector curved =
      hn::Mul(hn::Mul(length, bend), hn::Mul(behavior.Change, hn::Set(tag, BendFactor)));
    const Vector deep = hn::Mul(hn::Mul(length, behavior.Extinction),
      hn::Mul(hn::Mul(behavior.Tinge, range), hn::Set(tag, ColorFactor)));
    const Vector count = hn::Ceil(hn::Sqrt(hn::Max(curved, deep)));
    return hn::Min(hn::Max(count, hn::Set(tag, 1.0)), hn::Set(tag, MostPieces));
  }

  /// Finds the behavior of the function between the values at the corners of the cells of `lanes`.
  HWY_INLINE void FindBehavior(
    const Vector corners[8], std::uint32_t lanes, MediumBehavior<D>& found) const
  {
    const D tag;
    Vector least = corners[0];
    Vector largest = corners[0];
    for (int corner = 1; corner < 8; ++corner)
    {
      least = hn::Min(least, corners[corner]);
      largest = hn::Max(largest, corners[corner]);
    }
    const Vector scale = hn::Set(tag, this->Function.GetScale());
    HWY_ALIGN double first[Width];
    HWY_ALIGN double last[Width];
    HWY_ALIGN double extinctions[Width];
    HWY_ALIGN double changes[Width];
    HWY_ALIGN double tinges[Width];
    hn::Store(hn::Mul(least, scale), tag, first);
    hn::Store(hn::Mul(largest, scale), tag, last);
    hn::Store(found.Extinction, tag, extinctions);
    hn::Store(found.Change, tag, changes);
    hn::Store(found.Tinge, tag, tinges);
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      const TransferFunction::Behavior behavior =
        this->Function.FindBehavior(first[lane], last[lane]);
      extinctions[lane] = behavior.Extinction;
      changes[lane] = behavior.Change;
      tinges[lane] = behavior.Tinge;
    }
    found = { hn::Load(tag, extinctions), hn::Load(tag, changes), hn::Load(tag, tinges) };
  }

  /// TransferFunction::Integrate, and what it says of the slope; not a number in divided bins.
  HWY_INLINE Row Integrate(const Located& places, int lane) const
  {
    const TransferFunction::Bin& bin = this->Table[places.Number[lane]];
    const Row way(places.Way[lane]);
    return Row(bin.Integral) + (Row(bin.Begin) + Row(0.5) * (Row(bin.Growth) * way)) * way;
  }
  HWY_INLINE Row GetSlope(const Located& places, int lane) const
  {
    const TransferFunction::Bin& bin = this->Table[places.Number[lane]];
    return Row(bin.Begin) + Row(bin.Growth) * Row(places.Way[lane]);
  }
  /// The growth of the integral between two places, or the slope at the second one where `isShort`,
  /// in any bins. `integral`: becomes that up to the second one.
  HWY_NOINLINE Lanes IntegrateParts(double start, double stop, bool isShort, Lanes& integral) const
  {
    Lanes slope;
    const Lanes before = this->Function.Integrate(start, slope);
    integral = this->Function.Integrate(stop, slope);
    return isShort ? slope : integral - before;
  }

  /// Goes on to where piece `number` ends, for those of `lanes` that have as many. Returns those that are dark.
  template <class Crossed>
  HWY_INLINE std::uint32_t Add(
    const Crossed& crossed, int number, std::uint32_t lanes, Pieces& pieces)
  {
    const D tag;
    const Vector one = hn::Set(tag, 1.0);
    const Vector begin = hn::Mul(hn::Set(tag, static_cast<double>(number - 1)), pieces.Part);
    // The last one is the end, whatever rounding does.
    const Vector end =
      hn::Min(one, hn::Mul(hn::Set(tag, static_cast<double>(number)), pieces.Part));
    lanes &= GetMaskBits(tag, hn::Le(begin, hn::Set(tag, 1.0 - 1e-9)));
    const Vector inner = hn::Add(pieces.Cubic[2], hn::Mul(end, pieces.Cubic[3]));
    const Vector places =
      hn::Add(pieces.Cubic[0], hn::Mul(end, hn::Add(pieces.Cubic[1], hn::Mul(end, inner))));
    const Vector way = hn::Sub(places, pieces.Place);
    const Mask isShort = hn::Le(hn::Abs(way), hn::Set(tag, ShortWay));
    const std::uint32_t shortOnes = GetMaskBits(tag, isShort);
    HWY_ALIGN double factors[Width];
    hn::Store(hn::IfThenElse(isShort, pieces.Length, hn::Div(pieces.Length, way)), tag, factors);
    HWY_ALIGN double starts[Width];
    HWY_ALIGN double stops[Width];
    hn::Store(pieces.Place, tag, starts);
    hn::Store(places, tag, stops);
    pieces.Place = places;
    const Located located(places, this->Function.GetTableSize());
    Lanes amounts[Width];
    HWY_ALIGN double depths[Width];
    hn::Store(hn::Zero(tag), tag, depths);
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      const Row integral = this->Integrate(located, lane);
      const Row growth = (shortOnes >> lane & 1) != 0 ? this->GetSlope(located, lane)
                                                      : integral - Row(pieces.Integral[lane]);
      (growth * Row(factors[lane])).Store(amounts[lane]);
      integral.Store(pieces.Integral[lane]);
      depths[lane] = amounts[lane].High[1];
    }
    Vector depth = hn::Load(tag, depths);
    std::uint32_t some = GetMaskBits(tag, hn::Not(hn::Le(depth, hn::Zero(tag))));
    if (some == 0)
    {
      return 0;
    }
    const std::uint32_t divided = GetMaskBits(tag, hn::IsNaN(depth));
    if (HWY_UNLIKELY(divided != 0))
    {
      for (std::uint32_t left = divided; left != 0; left &= left - 1)
      {
        const int lane = __builtin_ctz(left);
        const bool isShort = (shortOnes >> lane & 1) != 0;
        const Lanes growth =
          this->IntegrateParts(starts[lane], stops[lane], isShort, pieces.Integral[lane]);
        amounts[lane] = growth * Lanes(factors[lane]);
        depths[lane] = amounts[lane][3];
        some &= ~(std::uint32_t{ !(depths[lane] > 0.0) } << lane);
      }
      depth = hn::Load(tag, depths);
    }
    const Vector passed = GetTransmittance(depth);
    // (1 - exp(-depth)) / depth
    const Vector thin = hn::Sub(one, hn::Mul(hn::Set(tag, 0.5), depth));
    const Vector seen = hn::IfThenElse(
      hn::Lt(depth, hn::Set(tag, MediumLight::Thin)), thin, hn::Div(hn::Sub(one, passed), depth));
    const Vector distance = hn::Sub(crossed.Exit, crossed.Enter);
    HWY_ALIGN double passes[Width];
    HWY_ALIGN double parts[Width];
    HWY_ALIGN double begins[Width];
    HWY_ALIGN double ends[Width];
    hn::Store(passed, tag, passes);
    hn::Store(seen, tag, parts);
    hn::Store(hn::Add(crossed.Enter, hn::Mul(distance, begin)), tag, begins);
    hn::Store(hn::Add(crossed.Enter, hn::Mul(distance, end)), tag, ends);
    std::uint32_t ended = 0;
    for (; some != 0; some &= some - 1)
    {
      const int lane = __builtin_ctz(some);
      const int ray = static_cast<int>(crossed.Ray[lane]);
      if (this->Light.KeepsPieces)
      {
        this->Light.Keep(ray, begins[lane], ends[lane], amounts[lane], passes[lane]);
      }
      this->Light.First[ray] = std::min(this->Light.First[ray], begins[lane]);
      this->Light.Last[ray] = ends[lane];
      double& transmittance = this->Light.Transmittance[ray];
      if (transmittance > 0.5 && transmittance * passes[lane] <= 0.5)
      {
        this->Light.Middle[ray] = begins[lane] +
          (ends[lane] - begins[lane]) *
            this->FindPart(starts[lane], stops[lane], std::log(2.0 * transmittance) / depths[lane]);
      }
      Lanes& sum = this->Light.GetSum(ray);
      (Row(sum) + Row(amounts[lane]) * Row(transmittance * parts[lane])).Store(sum);
      transmittance *= passes[lane];
      ended |= std::uint32_t{ this->Light.IsDark(ray) } << lane;
    }
    return ended;
  }

  /// The part of a piece, between two places in bins, that has such a part of its optical depth.
  double FindPart(double start, double stop, double part) const
  {
    if (std::abs(stop - start) <= ShortWay)
    {
      return part;
    }
    const auto integrate = [&](double place)
    {
      Lanes slope;
      return this->Function.Integrate(place, slope)[3];
    };
    const double first = integrate(start);
    const double whole = integrate(stop) - first;
    double low = 0.0;
    double high = 1.0;
    for (int step = 0; step < 16; ++step)
    {
      const double middle = 0.5 * (low + high);
      const bool isBefore = (integrate(start + middle * (stop - start)) - first) / whole < part;
      (isBefore ? low : high) = middle;
    }
    return high;
  }

  const TransferFunction& Function;
  const TransferFunction::Bin* Table;
  MediumLight& Light;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
