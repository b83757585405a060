// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_LanesRow_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_LanesRow_inl_h
#undef rt_LanesRow_inl_h
#else
#define rt_LanesRow_inl_h
#endif

#include "DSMRayTracing/base/Lanes.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Four numbers, as Lanes has them, in vectors that are as wide as the processor's.
class LanesRow
{
public:
  using Tag = hn::CappedTag<double, 4>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int Parts = 4 / Width;

  LanesRow() = default;
  HWY_INLINE explicit LanesRow(double all)
  {
    for (auto& part : this->Part)
    {
      part = hn::Set(Tag(), all);
    }
  }
  HWY_INLINE explicit LanesRow(const Lanes& lanes)
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

  friend HWY_INLINE LanesRow operator+(const LanesRow& a, const LanesRow& b)
  {
    LanesRow sum;
    for (int part = 0; part < Parts; ++part)
    {
      sum.Part[part] = hn::Add(a.Part[part], b.Part[part]);
    }
    return sum;
  }
  friend HWY_INLINE LanesRow operator-(const LanesRow& a, const LanesRow& b)
  {
    LanesRow difference;
    for (int part = 0; part < Parts; ++part)
    {
      difference.Part[part] = hn::Sub(a.Part[part], b.Part[part]);
    }
    return difference;
  }
  friend HWY_INLINE LanesRow operator*(const LanesRow& a, const LanesRow& b)
  {
    LanesRow product;
    for (int part = 0; part < Parts; ++part)
    {
      product.Part[part] = hn::Mul(a.Part[part], b.Part[part]);
    }
    return product;
  }

private:
  hn::Vec<Tag> Part[Parts];
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
