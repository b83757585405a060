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

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
