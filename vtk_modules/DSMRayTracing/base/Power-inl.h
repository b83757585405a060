// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_Power_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_Power_inl_h
#undef rt_Power_inl_h
#else
#define rt_Power_inl_h
#endif

#include "DSMRayTracing/base/Transmittance-inl.h"

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

/// Returns base^power, for floats from 0 to 1 and a power that is not negative. The error is 1e-6 for powers up to 100.
/// The bits are the same for vectors of any width.
template <class Vector>
HWY_INLINE Vector GetPower(Vector base, float power)
{
  const hn::DFromV<Vector> tag;
  const hn::RebindToSigned<decltype(tag)> bits;
  const Vector one = hn::Set(tag, 1.0f);
  const Vector bounded = hn::Min(hn::Max(base, hn::Set(tag, 1e-30f)), one);
  // The exponent, and a number between sqrt(1/2) and sqrt(2).
  const auto start = hn::Set(bits, std::int32_t{ 0x3f3504f3 });
  const auto whole = hn::ShiftRight<23>(hn::Sub(hn::BitCast(bits, bounded), start));
  const Vector rest =
    hn::BitCast(tag, hn::Sub(hn::BitCast(bits, bounded), hn::ShiftLeft<23>(whole)));
  // ln(rest) = 2 artanh(z)
  const Vector z = hn::Div(hn::Sub(rest, one), hn::Add(rest, one));
  const Vector square = hn::Mul(z, z);
  constexpr float factors[] = { 2.0f / 9, 2.0f / 7, 2.0f / 5, 2.0f / 3, 2.0f };
  Vector sum = hn::Set(tag, factors[0]);
  for (std::size_t order = 1; order < std::size(factors); ++order)
  {
    sum = hn::Add(hn::Mul(sum, square), hn::Set(tag, factors[order]));
  }
  const Vector logarithm =
    hn::Add(hn::Mul(hn::ConvertTo(tag, whole), hn::Set(tag, 0.693147181f)), hn::Mul(z, sum));
  const Vector depth = hn::Mul(logarithm, hn::Set(tag, -power));
  return GetTransmittance(hn::Max(depth, hn::Zero(tag)));
}

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
