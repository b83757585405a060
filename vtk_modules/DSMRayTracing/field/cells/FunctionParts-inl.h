// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_FunctionParts_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_FunctionParts_inl_h
#undef rt_FunctionParts_inl_h
#else
#define rt_FunctionParts_inl_h
#endif

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/look/TransferFunction.h"

#include <hwy/highway.h>

#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Evaluates a transfer function for a vector of rays. Each lane keeps the part of the function that it is in, which is
/// linear: values along a ray rarely leave it.
template <class F>
class FunctionParts
{
public:
  using Vector = hn::Vec<F>;
  using Mask = hn::Mask<F>;
  using NumberTag = hn::RebindToSigned<F>;
  using Numbers = hn::Vec<NumberTag>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(F()));

  /// Keeps a reference.
  explicit FunctionParts(const TransferFunction& function)
    : Function(function)
    , Table(function.GetTable())
    , PartBegin(hn::Set(F(), std::numeric_limits<float>::infinity()))
    , PartEnd(this->PartBegin)
  {
  }

  /// Returns where any place from `least` to `most` may be visible.
  Mask MayBeSeen(Vector least, Vector most) const
  {
    const F tag;
    return hn::And(hn::Ge(most, hn::Set(tag, this->Table.SeenFirst)),
      hn::Le(least, hn::Set(tag, this->Table.SeenLast)));
  }
  /// Returns the places that are in the current part of their lane.
  Mask IsInPart(Vector place) const
  {
    return hn::And(hn::Ge(place, this->PartBegin), hn::Le(place, this->PartEnd));
  }
  /// Makes the part of each place the current one of its lane, of those `there`.
  HWY_INLINE void GoToParts(Vector place, Mask there)
  {
    const F tag;
    const Mask inside = hn::And(hn::Ge(place, this->PartBegin), hn::Lt(place, this->PartEnd));
    if (hn::AllFalse(tag, hn::AndNot(inside, there)))
    {
      return;
    }
    const NumberTag numbers;
    const Numbers part = this->FindParts(place);
    this->PartBegin = hn::GatherIndex(tag, this->Table.Begin.data(), part);
    this->PartEnd = hn::GatherIndex(tag, this->Table.Begin.data() + 1, part);
    const Numbers row = hn::ShiftLeft<3>(part);
    for (int channel = 0; channel < 4; ++channel)
    {
      this->Look[channel] = hn::GatherIndex(tag, this->Table.Rows.data() + channel, row);
      this->Growth[channel] = hn::GatherIndex(tag, this->Table.Rows.data() + 4 + channel, row);
    }
    // Part 0 has no begin, and does not grow.
    this->From =
      hn::IfThenElseZero(hn::RebindMask(tag, hn::Gt(part, hn::Zero(numbers))), this->PartBegin);
  }
  /// The function at a place of the current part.
  Vector Evaluate(int channel, Vector place) const
  {
    return hn::Add(this->Look[channel], hn::Mul(this->Growth[channel], hn::Sub(place, this->From)));
  }

  /// The means of the function between two places, of which the first is in the current part; the part of the second
  /// becomes the current one.
  HWY_INLINE void GetMeans(Vector first, Vector last, Mask there, Vector means[4])
  {
    const F tag;
    const Vector half = hn::Set(tag, 0.5f);
    const Mask inside = this->IsInPart(last);
    const Vector middle = hn::Mul(half, hn::Add(first, last));
    for (int channel = 0; channel < 4; ++channel)
    {
      means[channel] = this->Evaluate(channel, middle);
    }
    const Mask across = hn::AndNot(inside, there);
    if (hn::AllFalse(tag, across))
    {
      return;
    }
    // Where the two parts meet, if they do.
    const Mask rises = hn::Gt(last, first);
    const Vector node = hn::IfThenElse(rises, this->PartEnd, this->PartBegin);
    const Vector before = hn::Mul(half, hn::Add(first, node));
    const Vector way = hn::Div(hn::Set(tag, 1.0f), hn::Sub(last, first));
    const Vector share = hn::Mul(hn::Sub(node, first), way);
    Vector old[4];
    for (int channel = 0; channel < 4; ++channel)
    {
      old[channel] = hn::Mul(share, this->Evaluate(channel, before));
    }
    this->GoToParts(last, there);
    const Mask meet = hn::Eq(node, hn::IfThenElse(rises, this->PartBegin, this->PartEnd));
    const Vector behind = hn::Mul(half, hn::Add(node, last));
    const Vector rest = hn::Mul(hn::Sub(last, node), way);
    for (int channel = 0; channel < 4; ++channel)
    {
      const Vector both = hn::Add(old[channel], hn::Mul(rest, this->Evaluate(channel, behind)));
      means[channel] = hn::IfThenElse(inside, means[channel], both);
    }
    const std::uint32_t far = GetMaskBits(tag, hn::AndNot(meet, across));
    if (far != 0)
    {
      this->IntegrateParts(first, last, far, means);
    }
  }

private:
  /// The parts of the function that places are in.
  HWY_INLINE Numbers FindParts(Vector place) const
  {
    const F tag;
    const NumberTag numbers;
    const Vector first = hn::Set(tag, this->Table.First);
    const Vector bounded = hn::Min(hn::Max(hn::Sub(place, first), hn::Zero(tag)),
      hn::Set(tag, static_cast<float>(TransferFunction::Bins - 1)));
    Numbers part =
      hn::GatherIndex(numbers, this->Table.Index.data(), hn::ConvertTo(numbers, bounded));
    for (int step = this->Table.Steps; step-- > 0;)
    {
      const Numbers next = hn::Add(part, hn::Set(numbers, std::int32_t{ 1 } << step));
      const Vector begin = hn::GatherIndex(tag, this->Table.Begin.data(), next);
      part = hn::IfThenElse(hn::RebindMask(numbers, hn::Le(begin, place)), next, part);
    }
    return hn::IfThenElseZero(hn::RebindMask(numbers, hn::Ge(place, first)), part);
  }

  /// GetMeans of some lanes (bits), for any number of parts.
  HWY_NOINLINE void IntegrateParts(
    Vector first, Vector last, std::uint32_t lanes, Vector means[4]) const
  {
    const F tag;
    HWY_ALIGN float places[2][Width];
    HWY_ALIGN float found[4][Width];
    hn::Store(first, tag, places[0]);
    hn::Store(last, tag, places[1]);
    for (int channel = 0; channel < 4; ++channel)
    {
      hn::Store(means[channel], tag, found[channel]);
    }
    for (; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      const double begin = places[0][lane];
      const double end = places[1][lane];
      Lanes slope;
      const Lanes before = this->Function.Integrate(begin, slope);
      const Lanes growth =
        (this->Function.Integrate(end, slope) - before) * Lanes(1.0 / (end - begin));
      for (int channel = 0; channel < 4; ++channel)
      {
        found[channel][lane] = static_cast<float>(growth[channel]);
      }
    }
    for (int channel = 0; channel < 4; ++channel)
    {
      means[channel] = hn::Load(tag, found[channel]);
    }
  }

  const TransferFunction& Function;
  const TransferFunction::Table& Table;
  ///@{
  /// The current part of each lane.
  Vector PartBegin;
  Vector PartEnd;
  Vector From; ///< Evaluate: place of Look
  Vector Look[4];
  Vector Growth[4];
  ///@}
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
