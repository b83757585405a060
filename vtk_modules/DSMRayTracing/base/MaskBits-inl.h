// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_MaskBits_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MaskBits_inl_h
#undef rt_MaskBits_inl_h
#else
#define rt_MaskBits_inl_h
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Bit i is lane i, of at most 16.
template <class D>
std::uint32_t GetMaskBits(D tag, hn::Mask<D> mask)
{
  static_assert(hn::MaxLanes(D()) <= 16, "two bytes of bits");
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(tag, mask, bytes);
  return bytes[0] | bytes[1] << 8;
}

/// The inverse, of the lowest bits, for at most 16 lanes.
template <class D>
hn::Mask<D> GetBitMask(D tag, std::uint64_t bits)
{
  static_assert(hn::MaxLanes(D()) <= 16, "two bytes of bits");
  const std::uint8_t bytes[8] = { static_cast<std::uint8_t>(bits),
    static_cast<std::uint8_t>(bits >> 8) };
  return hn::LoadMaskBits(tag, bytes);
}

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
