// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_Transmittance_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_Transmittance_inl_h
#undef rt_Transmittance_inl_h
#else
#define rt_Transmittance_inl_h
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <iterator>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// exp(-depth) of floats that are not negative, to 2e-7 of 1; the same bits for vectors of any width.
template <class Vector>
HWY_INLINE Vector GetTransmittance(Vector depth)
{
  const hn::DFromV<Vector> tag;
  const hn::RebindToUnsigned<decltype(tag)> bits;
  const Vector bounded = hn::Min(depth, hn::Set(tag, 80.0f));
  // The power of two, and what is left: between -ln(2) / 2 and ln(2) / 2.
  const Vector large = hn::Set(tag, 12582912.0f);
  const Vector raised = hn::Sub(large, hn::Mul(bounded, hn::Set(tag, 1.44269504f)));
  const Vector power = hn::Sub(raised, large);
  const Vector high = hn::Mul(power, hn::Set(tag, 0.693145752f));
  const Vector low = hn::Mul(power, hn::Set(tag, 1.42860677e-6f));
  const Vector rest = hn::Sub(hn::Sub(hn::Neg(bounded), high), low);
  constexpr float factors[] = { 1.0f / 720, 1.0f / 120, 1.0f / 24, 1.0f / 6, 0.5f, 1.0f, 1.0f };
  Vector sum = hn::Set(tag, factors[0]);
  for (std::size_t order = 1; order < std::size(factors); ++order)
  {
    sum = hn::Add(hn::Mul(sum, rest), hn::Set(tag, factors[order]));
  }
  // The whole number stands in the lowest bits of `raised`.
  const auto exponent =
    hn::ShiftLeft<23>(hn::Add(hn::BitCast(bits, raised), hn::Set(bits, std::uint32_t{ 127 })));
  return hn::Mul(sum, hn::BitCast(tag, exponent));
}

/// (1 - exp(-depth)) / depth, the share of its emission that gets out of an even piece; `passed`: exp(-depth).
template <class Vector>
HWY_INLINE Vector GetSeenShare(Vector depth, Vector passed)
{
  const hn::DFromV<Vector> tag;
  constexpr float factors[] = { 1.0f / 120, -1.0f / 24, 1.0f / 6, -0.5f, 1.0f };
  Vector thin = hn::Set(tag, factors[0]);
  for (std::size_t order = 1; order < std::size(factors); ++order)
  {
    thin = hn::Add(hn::Mul(thin, depth), hn::Set(tag, factors[order]));
  }
  const Vector thick = hn::Div(hn::Sub(hn::Set(tag, 1.0f), passed), depth);
  return hn::IfThenElse(hn::Lt(depth, hn::Set(tag, 0.125f)), thin, thick);
}

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
