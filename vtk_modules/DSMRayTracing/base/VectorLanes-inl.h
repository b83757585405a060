// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_VectorLanes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_VectorLanes_inl_h
#undef rt_VectorLanes_inl_h
#else
#define rt_VectorLanes_inl_h
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Lane i holds the number getLane(i). Where numbers come from memory, that is faster than gathering
/// them is, also where there are instructions for it.
template <class T, int Lanes, class GetLane>
HWY_INLINE hn::Vec<hn::CappedTag<T, Lanes>> SetLanes(const GetLane& getLane, int first = 0)
{
  const hn::CappedTag<T, Lanes> tag;
  if constexpr (Lanes == 1)
  {
    return hn::Set(tag, getLane(first));
  }
#if HWY_TARGET != HWY_SCALAR
  else
  {
    constexpr int half = Lanes / 2;
    return hn::Combine(
      tag, SetLanes<T, half>(getLane, first + half), SetLanes<T, half>(getLane, first));
  }
#endif
}

/// Lane i from from[places[i]].
template <class T, int Lanes>
HWY_INLINE auto LoadLanes(const T* from, const std::size_t* places)
{
  return SetLanes<T, Lanes>([=](int lane) { return from[places[lane]]; });
}

/// Loads from[offsets] and from[offsets + 1]: half as many loads as of lanes.
template <class F>
HWY_INLINE void GatherPairs(
  const float* from, hn::Vec<hn::RebindToSigned<F>> offsets, hn::Vec<F>& first, hn::Vec<F>& second)
{
  const F tag;
  if constexpr (hn::MaxLanes(F()) == 1)
  {
    first = hn::GatherIndex(tag, from, offsets);
    second = hn::GatherIndex(tag, from + 1, offsets);
  }
#if HWY_TARGET != HWY_SCALAR
  else
  {
    const hn::Repartition<std::int64_t, F> pairs;
    const hn::Half<hn::RebindToSigned<F>> half;
    const auto load = [&](auto part)
    {
      return hn::BitCast(tag,
        hn::GatherOffset(pairs, reinterpret_cast<const std::int64_t*>(from),
          hn::ShiftLeft<2>(hn::PromoteTo(pairs, part))));
    };
    const auto lower = load(hn::LowerHalf(half, offsets));
    const auto upper = load(hn::UpperHalf(half, offsets));
    first = hn::ConcatEven(tag, upper, lower);
    second = hn::ConcatOdd(tag, upper, lower);
  }
#endif
}

/// Floats out of the doubles that `get(lane)` returns from a lane on, for half of the lanes, or for the only one.
template <class F, class Get>
HWY_INLINE hn::Vec<F> DemoteLanes(const Get& get)
{
  constexpr int lanes = static_cast<int>(hn::MaxLanes(F()));
  if constexpr (lanes == 1)
  {
    return hn::DemoteTo(F(), get(0));
  }
#if HWY_TARGET != HWY_SCALAR
  else
  {
    const hn::Half<F> half;
    return hn::Combine(F(), hn::DemoteTo(half, get(lanes / 2)), hn::DemoteTo(half, get(0)));
  }
#endif
}

/// Whole numbers from 0 to 2^52.
template <class Vector>
auto ToNumbers(Vector whole)
{
  const hn::DFromV<Vector> tag;
  const hn::RebindToUnsigned<decltype(tag)> numbers;
  // Added to this, they stand in the lowest bits.
  const Vector large = hn::Set(tag, 4503599627370496.0);
  return hn::Sub(hn::BitCast(numbers, hn::Add(large, whole)), hn::BitCast(numbers, large));
}

/// The inverse.
template <class Numbers>
auto ToReal(Numbers whole)
{
  const hn::DFromV<Numbers> numbers;
  const hn::RebindToFloat<decltype(numbers)> tag;
  const auto large = hn::Set(tag, 4503599627370496.0);
  return hn::Sub(hn::BitCast(tag, hn::Or(hn::BitCast(numbers, large), whole)), large);
}

/// Numbers of the lowest bits of words that have some.
template <class Numbers>
Numbers GetLowestBits(Numbers words)
{
  const hn::DFromV<Numbers> numbers;
  const hn::RebindToSigned<decltype(numbers)> integers;
  const hn::RebindToFloat<decltype(numbers)> tag;
  const Numbers lowest = hn::And(words, hn::Sub(hn::Zero(numbers), words));
  // It is the exponent; the 64th bit is a sign as well.
  const Numbers exponent =
    hn::ShiftRight<52>(hn::BitCast(numbers, hn::ConvertTo(tag, hn::BitCast(integers, lowest))));
  return hn::And(hn::Sub(exponent, hn::Set(numbers, std::uint64_t{ 1023 })),
    hn::Set(numbers, std::uint64_t{ 63 }));
}

/// Into [0, 1].
template <class Vector>
Vector ClampToUnit(Vector value)
{
  const hn::DFromV<Vector> tag;
  const Vector zero = hn::Zero(tag);
  const Vector one = hn::Set(tag, 1.0);
  const Vector raised = hn::IfThenElse(hn::Gt(value, zero), value, zero);
  return hn::IfThenElse(hn::Lt(raised, one), raised, one);
}

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
