// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_MediumPieces_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MediumPieces_inl_h
#undef rt_MediumPieces_inl_h
#else
#define rt_MediumPieces_inl_h
#endif

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/Transmittance-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/MediumTolerance.h"
#include "DSMRayTracing/field/cells/FunctionParts-inl.h"
#include "DSMRayTracing/look/TransferFunction.h"
#include "DSMRayTracing/ray/MediumLight.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Integrates a transfer function along ways on which values are cubics, for a vector of rays, each in a lane of its
/// own, and adds what comes of it to their sums. All in single precision: sums of a ray are taken out of a MediumLight
/// for as many ways as there are in a brick, and put back.
///
/// A way is cut into pieces in which values are nearly linear, as far as the function makes a difference. A piece
/// within one part of the function, which is linear there, is exact whatever its values do.
template <class F>
class MediumPieces
{
public:
  using Vector = hn::Vec<F>;
  using Mask = hn::Mask<F>;
  using NumberTag = hn::RebindToSigned<F>;
  using Numbers = hn::Vec<NumberTag>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(F()));

  /// Values along ways, in places of the function: where they begin, in the middle and where they end.
  struct Ways
  {
    Vector First;
    Vector Middle;
    Vector Last;
    /// Factor of s (s - 1/2) (s - 1), for s from 0 to 1, that is added to the quadratic through these.
    Vector Cubic;
    Vector Length; ///< in the space of the medium
    Vector Begin;  ///< in the unit of SetRays
    Vector End;
  };
  /// The function's behavior where ways are: Change, and Extinction times Tinge, of TransferFunction::Behavior.
  struct Behavior
  {
    Vector Change;
    Vector Deep;
  };

  /// Keeps references.
  MediumPieces(const TransferFunction& function, MediumLight& light)
    : Function(function)
    , Parts(function)
    , Light(light)
    , JoinedLength(static_cast<float>(light.JoinedLength))
    , ErrorFactor(
        static_cast<float>(light.ErrorFactor * (light.IsExact ? MediumTolerance::Exact : 1.0)))
  {
  }

  /// Takes rays `number`[lane], of `lanes` (bits). Begin and End of ways are in a unit `scale`[lane] of T, from
  /// `origin`[lane] on. Keeps the pointers.
  void SetRays(
    const std::size_t* number, std::uint32_t lanes, const double* origin, const double* scale)
  {
    const F tag;
    this->Ray = number;
    this->Origin = origin;
    this->Scale = scale;
    std::size_t own[Width];
    for (int lane = 0; lane < Width; ++lane)
    {
      own[lane] = number[(lanes >> lane & 1) != 0 ? lane : __builtin_ctz(lanes)];
    }
    const auto load = [&](const double* sums)
    {
      return DemoteLanes<F>(
        [&](int part) { return LoadLanes<double, (Width + 1) / 2>(sums, own + part); });
    };
    for (int channel = 0; channel < 3; ++channel)
    {
      this->Sum[channel] = load(this->Light.Sum[channel]);
    }
    this->Transmittance = load(this->Light.Transmittance);
    this->Nearest = hn::Set(tag, std::numeric_limits<float>::infinity());
    this->Farthest = hn::Neg(this->Nearest);
    std::fill_n(this->Place, MediumLight::Places, this->Nearest);
  }
  /// Puts back the sums of `lanes`.
  void PutRays(std::uint32_t lanes)
  {
    const F tag;
    HWY_ALIGN float sums[6][Width];
    for (int channel = 0; channel < 3; ++channel)
    {
      hn::Store(this->Sum[channel], tag, sums[channel]);
    }
    hn::Store(this->Transmittance, tag, sums[3]);
    hn::Store(this->Nearest, tag, sums[4]);
    hn::Store(this->Farthest, tag, sums[5]);
    for (std::uint32_t left = lanes; left != 0; left &= left - 1)
    {
      const int lane = __builtin_ctz(left);
      const std::size_t ray = this->Ray[lane];
      for (int channel = 0; channel < 3; ++channel)
      {
        this->Light.Sum[channel][ray] = static_cast<double>(sums[channel][lane]);
      }
      this->Light.Transmittance[ray] = static_cast<double>(sums[3][lane]);
      if (sums[4][lane] <= sums[5][lane])
      {
        this->Light.First[ray] = std::min(this->Light.First[ray], this->GetT(lane, sums[4][lane]));
        this->Light.Last[ray] = this->GetT(lane, sums[5][lane]);
      }
    }
    if (this->Light.LocatesPlaces)
    {
      this->PutPlaces(lanes);
    }
  }

  /// Between these, ways add to sums of their own, which are shaded at one place.
  void BeginShaded()
  {
    this->IsShaded = true;
    for (Vector& channel : this->Own)
    {
      channel = hn::Zero(F());
    }
    this->Moment = hn::Zero(F());
    this->Before = this->Transmittance;
  }
  /// Returns whether there is anything.
  bool HasShaded() const { return !hn::AllTrue(F(), hn::Ge(this->Transmittance, this->Before)); }
  /// Where, on the mean, that is what is seen of it; `middle` where there is nothing.
  Vector FindCenter(Vector middle) const
  {
    const F tag;
    const Vector opacity = hn::Sub(this->Before, this->Transmittance);
    return hn::IfThenElse(hn::Gt(opacity, hn::Set(tag, 1e-6f)),
      hn::Div(this->Moment, hn::Max(opacity, hn::Set(tag, 1e-6f))), middle);
  }
  /// How opaque all in front of its middle is.
  Vector GetOpacity() const
  {
    const F tag;
    return hn::Sub(
      hn::Set(tag, 1.0f), hn::Mul(hn::Set(tag, 0.5f), hn::Add(this->Before, this->Transmittance)));
  }
  /// Adds it, its emission times a factor, and its opacity times another.
  void EndShaded(const Vector ofEmission[3], const Vector ofOpacity[3])
  {
    const Vector opacity = hn::Sub(this->Before, this->Transmittance);
    for (int channel = 0; channel < 3; ++channel)
    {
      this->Sum[channel] = hn::Add(this->Sum[channel],
        hn::Add(
          hn::Mul(this->Own[channel], ofEmission[channel]), hn::Mul(opacity, ofOpacity[channel])));
    }
  }

  /// How much the pixel sees of lengths; where density is known later, at most.
  Vector GetSeen(Vector length) const
  {
    const Vector whole = hn::Mul(length, hn::Set(F(), this->ErrorFactor));
    return this->Light.HasLateExtinction ? whole : hn::Mul(whole, this->Transmittance);
  }
  /// Rays that let so little light through that what follows does not count.
  Mask FindDark() const
  {
    return hn::Lt(this->Transmittance, hn::Set(F(), static_cast<float>(this->Light.DarkBelow)));
  }

  /// Adds the ways of those `there`. `around`: in values that include those of the ways.
  HWY_INLINE void Add(const Ways& ways, Mask there, const Behavior& around)
  {
    const F tag;
    const Vector one = hn::Set(tag, 1.0f);
    Vector least;
    Vector most;
    FindRange(ways, least, most);
    there = hn::And(there, this->Parts.MayBeSeen(least, most));
    if (hn::AllFalse(tag, there))
    {
      return;
    }
    this->Parts.GoToParts(ways.First, there);
    const Mask simple = hn::And(this->Parts.IsInPart(least), this->Parts.IsInPart(most));
    Vector count = this->GetCount(ways, simple, around);
    const std::uint32_t several = GetMaskBits(tag, hn::And(there, hn::Gt(count, one)));
    Behavior behavior = around;
    if (several != 0)
    {
      this->FindBehavior(least, most, several, behavior);
      count = this->GetCount(ways, simple, behavior);
    }
    if (this->JoinedLength > 0.0f)
    {
      count = hn::Max(count, this->GetDescribedCount(ways, least, most, there));
    }
    const Mask divided = hn::And(there, hn::Gt(count, one));
    if (hn::AllFalse(tag, divided))
    {
      this->AddPieces(ways, there);
      return;
    }
    this->AddPieces(ways, hn::AndNot(divided, there));
    this->AddDivided(ways, divided, count);
  }

private:
  static constexpr float MostPieces = 64.0f;
  static constexpr float BendFactor = static_cast<float>(1.0 / (32.0 * MediumTolerance::Depth));
  static constexpr float ColorFactor = static_cast<float>(1.0 / (12.0 * MediumTolerance::Color));

  void PutPlaces(std::uint32_t lanes)
  {
    HWY_ALIGN float found[Width];
    for (int number = 0; number < MediumLight::Places; ++number)
    {
      hn::Store(this->Place[number], F(), found);
      for (std::uint32_t left = lanes; left != 0; left &= left - 1)
      {
        const int lane = __builtin_ctz(left);
        if (found[lane] < std::numeric_limits<float>::infinity())
        {
          this->Light.Place[number][this->Ray[lane]] = this->GetT(lane, found[lane]);
        }
      }
    }
  }
  /// Finds MediumLight::Place in pieces that light gets through up to `after`, which is taken for linear.
  HWY_INLINE void FindPlaces(const Ways& ways, Vector after, Mask there)
  {
    const F tag;
    const Vector before = this->Transmittance;
    const Vector way = hn::Div(hn::Sub(ways.End, ways.Begin),
      hn::Max(hn::Sub(before, after), hn::Set(tag, std::numeric_limits<float>::min())));
    for (int number = 0; number < MediumLight::Places; ++number)
    {
      const Vector level = hn::Set(
        tag, 1.0f - (static_cast<float>(number) + 0.5f) / static_cast<float>(MediumLight::Places));
      const Mask here = hn::And(there, hn::And(hn::Gt(before, level), hn::Le(after, level)));
      const Vector place = hn::Add(ways.Begin, hn::Mul(hn::Sub(before, level), way));
      this->Place[number] = hn::IfThenElse(here, place, this->Place[number]);
    }
  }

  double GetT(int lane, float place) const
  {
    return this->Origin[lane] + static_cast<double>(place) * this->Scale[lane];
  }

  /// Returns the number of pieces. `simple`: ways within a part of the function.
  Vector GetCount(const Ways& ways, Mask simple, const Behavior& behavior) const
  {
    const F tag;
    const Vector twice = hn::Add(ways.Middle, ways.Middle);
    const Vector bend =
      hn::Add(hn::Mul(hn::Set(tag, 4.0f), hn::Abs(hn::Sub(hn::Add(ways.First, ways.Last), twice))),
        hn::Mul(hn::Set(tag, 3.0f), hn::Abs(ways.Cubic)));
    const Vector range =
      hn::Add(hn::Abs(hn::Sub(ways.Middle, ways.First)), hn::Abs(hn::Sub(ways.Last, ways.Middle)));
    const Vector seen = this->GetSeen(ways.Length);
    const Vector curved =
      hn::Mul(hn::Mul(seen, bend), hn::Mul(behavior.Change, hn::Set(tag, BendFactor)));
    const Vector deep =
      hn::Mul(hn::Mul(seen, range), hn::Mul(behavior.Deep, hn::Set(tag, ColorFactor)));
    const Vector larger = hn::Max(hn::IfThenZeroElse(simple, curved), deep);
    const Vector count = hn::Ceil(hn::Sqrt(larger));
    return hn::Min(hn::Max(count, hn::Set(tag, 1.0f)), hn::Set(tag, MostPieces));
  }
  /// A range that no value of the ways is outside of.
  static void FindRange(const Ways& ways, Vector& least, Vector& most)
  {
    // No extremum of a cubic is farther from all of the three values.
    const Vector twice = hn::Add(ways.Middle, ways.Middle);
    const Vector room = hn::Mul(hn::Set(F(), 0.125f),
      hn::Add(hn::Abs(hn::Sub(hn::Add(ways.First, ways.Last), twice)), hn::Abs(ways.Cubic)));
    least = hn::Sub(hn::Min(hn::Min(ways.First, ways.Last), ways.Middle), room);
    most = hn::Add(hn::Max(hn::Max(ways.First, ways.Last), ways.Middle), room);
  }
  /// Finds the behavior in the ranges of those lanes (bits).
  HWY_NOINLINE void FindBehavior(
    Vector least, Vector most, std::uint32_t lanes, Behavior& found) const
  {
    const F tag;
    HWY_ALIGN float numbers[4][Width];
    hn::Store(least, tag, numbers[0]);
    hn::Store(most, tag, numbers[1]);
    hn::Store(found.Change, tag, numbers[2]);
    hn::Store(found.Deep, tag, numbers[3]);
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      const TransferFunction::Behavior own =
        this->Function.FindBehavior(numbers[0][lane], numbers[1][lane]);
      numbers[2][lane] = static_cast<float>(own.Change);
      numbers[3][lane] = static_cast<float>(own.Extinction * own.Tinge);
    }
    found.Change = hn::Load(tag, numbers[2]);
    found.Deep = hn::Load(tag, numbers[3]);
  }

  /// Pieces are described one by one, and light changes along the way.
  HWY_NOINLINE Vector GetDescribedCount(
    const Ways& ways, Vector least, Vector most, Mask there) const
  {
    const F tag;
    HWY_ALIGN float numbers[3][Width];
    hn::Store(least, tag, numbers[0]);
    hn::Store(most, tag, numbers[1]);
    hn::Store(hn::Set(tag, 1.0f / this->JoinedLength), tag, numbers[2]);
    for (std::uint32_t lanes = GetMaskBits(tag, there); lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      const double extinction =
        this->Function.FindBehavior(numbers[0][lane], numbers[1][lane]).Extinction;
      numbers[2][lane] = std::max(
        numbers[2][lane], static_cast<float>(extinction * MediumTolerance::DescribedPieces));
    }
    return hn::Min(
      hn::Ceil(hn::Mul(ways.Length, hn::Load(tag, numbers[2]))), hn::Set(tag, MostPieces));
  }

  /// Adds ways that are cut into `count` pieces.
  HWY_INLINE void AddDivided(const Ways& ways, Mask there, Vector count)
  {
    const F tag;
    const Vector one = hn::Set(tag, 1.0f);
    const Vector part = hn::Div(one, count);
    const Vector twice = hn::Add(ways.Middle, ways.Middle);
    const Vector bend = hn::Mul(hn::Set(tag, 2.0f), hn::Sub(hn::Add(ways.First, ways.Last), twice));
    const Vector slope = hn::Sub(hn::Sub(ways.Last, ways.First), bend);
    const auto evaluate = [&](Vector s)
    {
      const Vector cubic =
        hn::Mul(ways.Cubic, hn::Mul(hn::Sub(s, hn::Set(tag, 0.5f)), hn::Sub(s, one)));
      return hn::Add(ways.First, hn::Mul(s, hn::Add(hn::Add(slope, hn::Mul(s, bend)), cubic)));
    };
    const Vector whole = hn::Sub(ways.End, ways.Begin);
    Ways piece;
    piece.First = ways.First;
    piece.Begin = ways.Begin;
    piece.Length = hn::Mul(ways.Length, part);
    Mask left = there;
    Vector number = one;
    while (!hn::AllFalse(tag, left))
    {
      const Vector end = hn::Mul(number, part);
      const Mask isLast = hn::Ge(number, count);
      piece.Middle = evaluate(hn::Mul(hn::Sub(number, hn::Set(tag, 0.5f)), part));
      piece.Last = hn::IfThenElse(isLast, ways.Last, evaluate(end));
      piece.End = hn::IfThenElse(isLast, ways.End, hn::Add(ways.Begin, hn::Mul(whole, end)));
      // The others wait until as many as possible have a piece that may be seen.
      const Mask seen =
        this->Parts.MayBeSeen(hn::Min(hn::Min(piece.First, piece.Last), piece.Middle),
          hn::Max(hn::Max(piece.First, piece.Last), piece.Middle));
      const Mask hidden = hn::AndNot(seen, left);
      const bool isAnyHidden = !hn::AllFalse(tag, hidden);
      const Mask next = isAnyHidden ? hidden : left;
      Mask ended = hn::And(isLast, next);
      if (!isAnyHidden)
      {
        this->AddPieces(piece, left);
        ended = hn::Or(ended, this->FindDark());
      }
      left = hn::AndNot(ended, left);
      piece.First = hn::IfThenElse(next, piece.Last, piece.First);
      piece.Begin = hn::IfThenElse(next, piece.End, piece.Begin);
      number = hn::IfThenElse(next, hn::Add(number, one), number);
    }
  }

  /// Adds ways, each as one piece.
  HWY_INLINE void AddPieces(const Ways& ways, Mask there)
  {
    const F tag;
    if (hn::AllFalse(tag, there))
    {
      return;
    }
    this->Parts.GoToParts(ways.First, there);
    const Mask simple = hn::And(this->Parts.IsInPart(ways.Middle), this->Parts.IsInPart(ways.Last));
    // Simpson's rule is exact for cubics.
    const Vector mean = hn::Mul(hn::Set(tag, 1.0f / 6.0f),
      hn::Add(hn::Add(ways.First, ways.Last), hn::Mul(hn::Set(tag, 4.0f), ways.Middle)));
    Vector amount[4];
    for (int channel = 0; channel < 4; ++channel)
    {
      amount[channel] = this->Parts.Evaluate(channel, mean);
    }
    if (!hn::AllFalse(tag, hn::AndNot(simple, there)))
    {
      const Mask others = hn::AndNot(simple, there);
      Vector front[4];
      Vector back[4];
      this->Parts.GetMeans(ways.First, ways.Middle, others, front);
      this->Parts.GetMeans(ways.Middle, ways.Last, others, back);
      for (int channel = 0; channel < 4; ++channel)
      {
        amount[channel] = hn::IfThenElse(simple, amount[channel],
          hn::Mul(hn::Set(tag, 0.5f), hn::Add(front[channel], back[channel])));
      }
    }
    for (Vector& one : amount)
    {
      one = hn::Mul(one, ways.Length);
    }
    this->Blend(ways, amount, hn::And(there, hn::Gt(amount[3], hn::Zero(tag))));
  }

  /// Adds pieces with such emission and depth.
  HWY_INLINE void Blend(const Ways& ways, const Vector amount[4], Mask there)
  {
    const F tag;
    const Vector passed = GetTransmittance(hn::IfThenElseZero(there, amount[3]));
    const Vector after = hn::Mul(this->Transmittance, passed);
    const Vector half = hn::Set(tag, 0.5f);
    const std::uint32_t halved = GetMaskBits(
      tag, hn::And(there, hn::And(hn::Gt(this->Transmittance, half), hn::Le(after, half))));
    if (halved != 0)
    {
      this->Locate(ways, amount[3], halved);
    }
    if (this->Light.LocatesPlaces)
    {
      this->FindPlaces(ways, after, there);
    }
    if (this->Light.KeepsPieces)
    {
      this->Keep(ways, amount, passed, GetMaskBits(tag, there));
    }
    const Vector share = hn::Mul(this->Transmittance, GetSeenShare(amount[3], passed));
    Vector* const sum = this->IsShaded ? this->Own : this->Sum;
    for (int channel = 0; channel < 3; ++channel)
    {
      // Lanes without a piece may hold anything.
      sum[channel] =
        hn::Add(sum[channel], hn::IfThenElseZero(there, hn::Mul(share, amount[channel])));
    }
    if (this->IsShaded)
    {
      const Vector middle = hn::Mul(half, hn::Add(ways.Begin, ways.End));
      this->Moment = hn::Add(this->Moment, hn::Mul(hn::Sub(this->Transmittance, after), middle));
    }
    this->Transmittance = after;
    this->Nearest = hn::IfThenElse(there, hn::Min(this->Nearest, ways.Begin), this->Nearest);
    this->Farthest = hn::IfThenElse(there, ways.End, this->Farthest);
  }

  /// Finds where half of the light is gone, in pieces of those lanes (bits).
  HWY_NOINLINE void Locate(const Ways& ways, Vector depth, std::uint32_t lanes)
  {
    const F tag;
    HWY_ALIGN float numbers[7][Width];
    hn::Store(ways.First, tag, numbers[0]);
    hn::Store(ways.Last, tag, numbers[1]);
    hn::Store(ways.Begin, tag, numbers[2]);
    hn::Store(ways.End, tag, numbers[3]);
    hn::Store(depth, tag, numbers[4]);
    hn::Store(this->Transmittance, tag, numbers[5]);
    hn::Store(ways.Middle, tag, numbers[6]);
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      const double front = this->GetMeanExtinction(numbers[0][lane], numbers[6][lane]);
      const double back = this->GetMeanExtinction(numbers[6][lane], numbers[1][lane]);
      const double wanted = std::log(2.0 * numbers[5][lane]) / numbers[4][lane] * (front + back);
      const double part = wanted <= front
        ? 0.5 * this->FindDepth(numbers[0][lane], numbers[6][lane], wanted / front)
        : 0.5 + 0.5 * this->FindDepth(numbers[6][lane], numbers[1][lane], (wanted - front) / back);
      const double begin = this->GetT(lane, numbers[2][lane]);
      const double end = this->GetT(lane, numbers[3][lane]);
      this->Light.Middle[this->Ray[lane]] = begin + part * (end - begin);
    }
  }
  double GetMeanExtinction(double start, double stop) const
  {
    Lanes slope;
    const Lanes first = this->Function.Integrate(start, slope);
    return std::abs(stop - start) <= MediumTolerance::ShortWay
      ? slope[3]
      : (this->Function.Integrate(stop, slope)[3] - first[3]) / (stop - start);
  }
  /// The part of a way, between two places, that has such a part of its optical depth.
  double FindDepth(double start, double stop, double part) const
  {
    if (std::abs(stop - start) <= MediumTolerance::ShortWay)
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

  /// Keeps the pieces of those lanes (bits).
  HWY_NOINLINE void Keep(
    const Ways& ways, const Vector amount[4], Vector passed, std::uint32_t lanes)
  {
    const F tag;
    HWY_ALIGN float numbers[11][Width];
    for (int channel = 0; channel < 4; ++channel)
    {
      hn::Store(amount[channel], tag, numbers[channel]);
    }
    hn::Store(ways.Begin, tag, numbers[4]);
    hn::Store(ways.End, tag, numbers[5]);
    hn::Store(passed, tag, numbers[6]);
    hn::Store(this->Transmittance, tag, numbers[7]);
    hn::Store(ways.First, tag, numbers[8]);
    hn::Store(ways.Middle, tag, numbers[9]);
    hn::Store(ways.Last, tag, numbers[10]);
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      const auto ray = static_cast<int>(this->Ray[lane]);
      this->Light.Transmittance[ray] = numbers[7][lane];
      MediumPiece piece{ this->GetT(lane, numbers[4][lane]), this->GetT(lane, numbers[5][lane]),
        Lanes(numbers[0][lane], numbers[1][lane], numbers[2][lane], numbers[3][lane]) };
      for (int value = 0; value < 3; ++value)
      {
        piece.Values[value] = numbers[8 + value][lane];
      }
      this->Light.Keep(ray, piece, numbers[6][lane]);
    }
  }

  const TransferFunction& Function;
  FunctionParts<F> Parts;
  MediumLight& Light;
  float JoinedLength;
  float ErrorFactor;
  const std::size_t* Ray = nullptr;
  const double* Origin = nullptr;
  const double* Scale = nullptr;
  Vector Sum[3];
  Vector Transmittance;
  ///@{
  /// BeginShaded
  bool IsShaded = false;
  Vector Own[3];
  Vector Moment; ///< of opacity
  Vector Before; ///< transmittance
  ///@}
  Vector Place[MediumLight::Places];
  Vector Nearest; ///< where there is anything first
  Vector Farthest;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
