// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_MediumCells_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MediumCells_inl_h
#undef rt_MediumCells_inl_h
#else
#define rt_MediumCells_inl_h
#endif

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/base/LanesRow-inl.h"
#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/Transmittance-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/MediumTolerance.h"
#include "DSMRayTracing/field/cells/CellCrossing-inl.h"
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

/// Visitor for rays through a medium; see CellCrossing. Within a cell, the value along a ray is a cubic. It is divided
/// into enough pieces that it is nearly linear in each, as far as the transfer function makes a difference; each piece
/// is integrated over its values. A crossing may stand for several cells in which values hardly bend.
template <class D>
class MediumCells
{
public:
  static constexpr bool NeedsBehavior = true;
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  MediumCells(const TransferFunction& function, MediumLight& light)
    : Function(function)
    , Table(function.GetTable())
    , Light(light)
  {
  }

  template <class Crossing>
  HWY_INLINE std::uint32_t Visit(const Crossing& cells)
  {
    const std::uint32_t left = GetMaskBits(D(), cells.Crossing) & cells.There;
    return left == 0 ? 0 : this->Go(cells, left);
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

  /// Takes those of `left` through their cells. Returns those that are dark then.
  template <class Crossing>
  HWY_INLINE std::uint32_t Go(const Crossing& crossed, std::uint32_t left)
  {
    const D tag;
    Pieces pieces;
    crossed.GetCubics().GetCoefficients(pieces.Cubic);
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
    if constexpr (Crossing::HasRange)
    {
      const std::uint32_t several = GetMaskBits(tag, hn::Gt(count, one)) & left;
      if (several != 0)
      {
        this->FindBehavior(crossed, several, behavior);
        count = GetCount(length, bend, range, behavior);
      }
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

  /// Finds the behavior of the function in the ranges of the cells of `lanes`.
  template <class Crossing>
  HWY_INLINE void FindBehavior(
    const Crossing& crossed, std::uint32_t lanes, MediumBehavior<D>& found) const
  {
    const D tag;
    Vector least;
    Vector largest;
    crossed.FindRange(least, largest);
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
  HWY_INLINE LanesRow Integrate(const Located& places, int lane) const
  {
    const TransferFunction::Bin& bin = this->Table[places.Number[lane]];
    const LanesRow way(places.Way[lane]);
    return LanesRow(bin.Integral) +
      (LanesRow(bin.Begin) + LanesRow(0.5) * (LanesRow(bin.Growth) * way)) * way;
  }
  HWY_INLINE LanesRow GetSlope(const Located& places, int lane) const
  {
    const TransferFunction::Bin& bin = this->Table[places.Number[lane]];
    return LanesRow(bin.Begin) + LanesRow(bin.Growth) * LanesRow(places.Way[lane]);
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
  template <class Crossing>
  HWY_INLINE std::uint32_t Add(
    const Crossing& crossed, int number, std::uint32_t lanes, Pieces& pieces)
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
      const LanesRow integral = this->Integrate(located, lane);
      const LanesRow growth = (shortOnes >> lane & 1) != 0
        ? this->GetSlope(located, lane)
        : integral - LanesRow(pieces.Integral[lane]);
      (growth * LanesRow(factors[lane])).Store(amounts[lane]);
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
      (LanesRow(sum) + LanesRow(amounts[lane]) * LanesRow(transmittance * parts[lane])).Store(sum);
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
