// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_Cubics_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_Cubics_inl_h
#undef rt_Cubics_inl_h
#else
#define rt_Cubics_inl_h
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// A part of a way at whose two ends a cubic differs in sign; see End in Cubic.cxx.
template <class D>
struct Bracket
{
  hn::Vec<D> BeginS;
  hn::Vec<D> BeginValue;
  hn::Vec<D> EndS;
  hn::Vec<D> EndValue;
};

/// Values along the ways of a vector of rays, each from 0 to 1: Cubic.h for several rays, with the same operations in
/// the same order, so that the results are equal bit for bit. A branch there becomes a selection here, or a loop that
/// continues while any ray needs it. It is known that a ray crosses before the position is known: so the last, long
/// part can wait until many rays have reached that point.
template <class D>
class Cubics
{
public:
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;

  /// `last`: values at the ends of the ways, with the same bits as at the begins of those that follow.
  HWY_INLINE Cubics(const Vector coefficients[4], Vector last)
    : Zero(hn::Zero(D()))
    , One(hn::Set(D(), 1.0))
    , C0(coefficients[0])
    , C1(coefficients[1])
    , C2(coefficients[2])
    , C3(coefficients[3])
    , Last(last)
  {
  }

  /// The cubic along the way is [0] + [1] s + [2] s^2 + [3] s^3.
  void GetCoefficients(Vector coefficients[4]) const
  {
    coefficients[0] = this->C0;
    coefficients[1] = this->C1;
    coefficients[2] = this->C2;
    coefficients[3] = this->C3;
  }

  /// The value at the end of the way.
  const Vector& GetLast() const { return this->Last; }

  /// The largest value on the way, and where it is first.
  void FindLargest(Vector& value, Vector& place) const
  {
    value = this->C0;
    place = this->Zero;
    const auto take = [&](Mask valid, Vector otherValue, Vector otherPlace)
    {
      const Mask larger = hn::And(valid, hn::Gt(otherValue, value));
      value = hn::IfThenElse(larger, otherValue, value);
      place = hn::IfThenElse(larger, otherPlace, place);
    };
    Vector extrema[2];
    this->FindExtrema(extrema);
    for (const Vector& other : extrema)
    {
      take(
        hn::And(hn::Gt(other, this->Zero), hn::Lt(other, this->One)), this->Evaluate(other), other);
    }
    take(hn::Eq(this->Last, this->Last), this->Last, this->One);
  }

  /// Which of `rays` cross, and where the first crossing of each is; undefined for the others.
  Mask FindFirst(Mask rays, Bracket<D>& bracket) const
  {
    const Mask inside0 = this->IsInside(this->C0);
    const Mask inside3 = this->IsInside(this->Last);
    const Mask single = hn::Xor(inside0, inside3);
    const Mask several = hn::And(rays, this->MayCrossAgain(inside0, inside3));
    bracket = { this->Zero, this->C0, this->One, this->Last };
    Mask crossing = hn::And(rays, single);
    if (hn::AllFalse(D(), several))
    {
      return crossing;
    }
    Vector extrema[2];
    this->FindExtrema(extrema);
    Mask open = several; // no bracket found yet
    for (const Vector& place : extrema)
    {
      const Mask valid =
        hn::And(open, hn::And(hn::Gt(place, this->Zero), hn::Lt(place, this->One)));
      const Vector value = this->Evaluate(place);
      const Mask found = hn::And(valid, hn::Xor(this->IsInside(value), inside0));
      const Mask passed = hn::AndNot(found, valid);
      bracket.EndS = hn::IfThenElse(found, place, bracket.EndS);
      bracket.EndValue = hn::IfThenElse(found, value, bracket.EndValue);
      bracket.BeginS = hn::IfThenElse(passed, place, bracket.BeginS);
      bracket.BeginValue = hn::IfThenElse(passed, value, bracket.BeginValue);
      crossing = hn::Or(crossing, found);
      open = hn::AndNot(found, open);
    }
    return crossing;
  }

  /// How often each of `rays` crosses; 0 for the others.
  Vector Count(Mask rays) const
  {
    Mask inside = this->IsInside(this->C0);
    const Mask inside3 = this->IsInside(this->Last);
    const Mask several = hn::And(rays, this->MayCrossAgain(inside, inside3));
    Vector count = this->Zero;
    if (!hn::AllFalse(D(), several))
    {
      Vector extrema[2];
      this->FindExtrema(extrema);
      for (const Vector& place : extrema)
      {
        const Mask valid =
          hn::And(several, hn::And(hn::Gt(place, this->Zero), hn::Lt(place, this->One)));
        const Mask change = hn::And(valid, hn::Xor(this->IsInside(this->Evaluate(place)), inside));
        count = hn::Add(count, hn::IfThenElseZero(change, this->One));
        inside = hn::Xor(inside, change);
      }
    }
    const Mask change = hn::And(rays, hn::Xor(inside, inside3));
    return hn::Add(count, hn::IfThenElseZero(change, this->One));
  }

  /// Returns the crossings of `rays` in their brackets; undefined for the other rays.
  Vector Refine(Mask rays, const Bracket<D>& bracket) const
  {
    const D tag;
    const Vector tolerance = hn::Set(tag, 1e-7);
    const Vector half = hn::Set(tag, 0.5);
    const Mask beginInside = this->IsInside(bracket.BeginValue);
    Vector low = bracket.BeginS;
    Vector high = bracket.EndS;
    const Vector chord = hn::Div(bracket.BeginValue, hn::Sub(bracket.BeginValue, bracket.EndValue));
    const Vector width = hn::Sub(high, low);
    const Vector clamped = Clamp(chord, hn::Set(tag, 0.015625), hn::Set(tag, 0.984375));
    Vector s = hn::Add(low, hn::Mul(width, clamped));
    Vector lastStep = width;
    Mask active = hn::And(rays, hn::Gt(hn::Sub(high, low), tolerance));
    while (!hn::AllFalse(tag, active))
    {
      const Vector value = this->Evaluate(s);
      const Mask before = hn::Not(hn::Xor(this->IsInside(value), beginInside));
      low = hn::IfThenElse(hn::And(active, before), s, low);
      high = hn::IfThenElse(hn::AndNot(before, active), s, high);
      const Vector next = hn::Sub(s, hn::Div(value, this->EvaluateDerivative(s)));
      const Vector step = hn::Abs(hn::Sub(next, s));
      const Mask small = hn::And(active, hn::Le(step, tolerance));
      Mask done = small;
      if (!hn::AllFalse(tag, small))
      {
        done = hn::And(small, this->IsCrossing(next, low, high, tolerance, beginInside));
      }
      const Mask inBracket = hn::And(hn::Gt(next, low), hn::Lt(next, high));
      const Mask newton =
        hn::And(inBracket, hn::And(hn::Gt(step, tolerance), hn::Lt(step, hn::Mul(half, lastStep))));
      const Vector middle = hn::Mul(half, hn::Add(low, high));
      const Vector going = hn::IfThenElse(newton, next, middle);
      lastStep = hn::IfThenElse(active, hn::IfThenElse(newton, step, hn::Sub(high, low)), lastStep);
      s = hn::IfThenElse(active, hn::IfThenElse(done, Clamp(next, low, high), going), s);
      active = hn::And(hn::AndNot(done, active), hn::Gt(hn::Sub(high, low), tolerance));
    }
    return s;
  }

private:
  Mask IsInside(Vector value) const { return hn::Ge(value, this->Zero); }

  /// Which rays may cross more than once: there are no more crossings than changes between the signs of the four
  /// Bernstein coefficients, of which those of the first and the last are given.
  Mask MayCrossAgain(Mask inside0, Mask inside3) const
  {
    const Vector third = hn::Set(D(), 1.0 / 3.0);
    const Vector two = hn::Set(D(), 2.0);
    const Mask inside1 = this->IsInside(hn::Add(this->C0, hn::Mul(this->C1, third)));
    const Mask inside2 =
      this->IsInside(hn::Add(this->C0, hn::Mul(hn::Add(hn::Mul(two, this->C1), this->C2), third)));
    const Mask change0 = hn::Xor(inside0, inside1);
    const Mask change1 = hn::Xor(inside1, inside2);
    const Mask change2 = hn::Xor(inside2, inside3);
    return hn::Or(hn::And(change0, hn::Or(change1, change2)), hn::And(change1, change2));
  }

  Vector Evaluate(Vector s) const
  {
    const Vector inner = hn::Add(this->C2, hn::Mul(s, this->C3));
    return hn::Add(this->C0, hn::Mul(s, hn::Add(this->C1, hn::Mul(s, inner))));
  }
  Vector EvaluateDerivative(Vector s) const
  {
    const Vector two = hn::Set(D(), 2.0);
    const Vector three = hn::Set(D(), 3.0);
    const Vector inner = hn::Add(hn::Mul(two, this->C2), hn::Mul(hn::Mul(s, three), this->C3));
    return hn::Add(this->C1, hn::Mul(s, inner));
  }

  /// The power of two that brings `largest` (>= 0) to about one.
  Vector GetScale(Vector largest) const
  {
    const hn::RebindToUnsigned<D> bits;
    constexpr int fraction = 52;
    const auto exponent = hn::Set(bits, std::uint64_t{ 0x7ff } << fraction);
    const auto bounded = hn::BitCast(bits, hn::Min(largest, hn::Set(D(), 0x1p1022)));
    return hn::BitCast(D(),
      hn::Sub(hn::Set(bits, std::uint64_t{ 2 * 1023 } << fraction), hn::And(bounded, exponent)));
  }

  /// Ascending; where there are none, not in (0, 1).
  void FindExtrema(Vector extrema[2]) const
  {
    const Vector scale =
      this->GetScale(hn::Max(hn::Abs(this->C3), hn::Max(hn::Abs(this->C2), hn::Abs(this->C1))));
    const Vector a = hn::Mul(hn::Set(D(), 3.0), hn::Mul(scale, this->C3));
    const Vector b = hn::Mul(scale, this->C2);
    const Vector c = hn::Mul(scale, this->C1);
    const Vector discriminant = hn::Sub(hn::Mul(b, b), hn::Mul(a, c));
    const Mask exist = hn::Gt(discriminant, this->Zero);
    const Vector q = hn::Neg(hn::Add(b, hn::CopySign(hn::Sqrt(discriminant), b)));
    const Vector first = hn::Div(q, a);
    const Vector second = hn::Div(c, q);
    const Mask swap = hn::Lt(second, first);
    extrema[0] = hn::IfThenElseZero(exist, hn::IfThenElse(swap, second, first));
    extrema[1] = hn::IfThenElseZero(exist, hn::IfThenElse(swap, first, second));
  }

  /// `value` within [low, high]; what is not a number stays so.
  static Vector Clamp(Vector value, Vector low, Vector high)
  {
    return hn::IfThenElse(
      hn::Lt(value, low), low, hn::IfThenElse(hn::Lt(high, value), high, value));
  }

  Mask IsCrossing(Vector place, Vector low, Vector high, Vector tolerance, Mask beginInside) const
  {
    const Vector back = hn::Sub(place, tolerance);
    const Vector ahead = hn::Add(place, tolerance);
    const Mask otherSideBack = hn::Xor(this->IsInside(this->Evaluate(back)), beginInside);
    const Mask otherSideAhead = hn::Xor(this->IsInside(this->Evaluate(ahead)), beginInside);
    return hn::And(hn::Or(hn::Le(back, low), hn::Not(otherSideBack)),
      hn::Or(hn::Ge(ahead, high), otherSideAhead));
  }

  Vector Zero;
  Vector One;
  Vector C0;
  Vector C1;
  Vector C2;
  Vector C3;
  Vector Last;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
