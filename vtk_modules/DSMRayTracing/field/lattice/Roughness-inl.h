// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_Roughness_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_Roughness_inl_h
#undef rt_Roughness_inl_h
#else
#define rt_Roughness_inl_h
#endif

#include "DSMRayTracing/field/lattice/MacrocellSamples.h"

#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// How much the values along a line in a macrocell can bend: a bound of their second derivative for a line that is as
/// long as a cell's edge, with trilinear values, whose slope changes between cells. The same bits for vectors of any
/// width.
template <int Lanes>
class Roughness
{
  static constexpr int RowSamples = 8; ///< that are looked at, though only five are there
  using Tag = hn::CappedTag<float, std::min(Lanes, RowSamples)>;
  using Vector = hn::Vec<Tag>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(Tag()));

  /// How much two differences that follow one another differ; `plane`: the one between them, or the first of a vector.
  static HWY_INLINE Vector GetChange(
    const MacrocellSamples& samples, int axis, int plane, Vector behind, Vector before)
  {
    const auto load = [&](const float* factors)
    { return axis == 0 ? hn::LoadU(Tag(), factors + plane) : hn::Set(Tag(), factors[plane]); };
    return hn::Sub(
      hn::Mul(load(samples.Behind[axis]), behind), hn::Mul(load(samples.Before[axis]), before));
  }

public:
  static double Find(const MacrocellSamples& samples)
  {
    const int* const counts = samples.Counts;
    // Along x twice, along x and y, and so on.
    Sizes xx;
    Sizes xy;
    Sizes xz;
    Sizes yy;
    Sizes yz;
    Sizes zz;
    for (int z = 0; z <= counts[2]; ++z)
    {
      for (int y = 0; y <= counts[1]; ++y)
      {
        const auto get = [&](int forY, int forZ, int part, int x)
        { return hn::LoadU(Tag(), samples.Values[z + forZ][y + forY] + part + x); };
        for (int part = 0; part < RowSamples; part += Width)
        {
          const Vector here = get(0, 0, part, 0);
          const Vector next = get(0, 0, part, 1);
          const Vector along = hn::Sub(next, here);
          xx.Raise(part, GetChange(samples, 0, part, hn::Sub(get(0, 0, part, 2), next), along));
          if (y < counts[1])
          {
            const Vector beside = get(1, 0, part, 0);
            xy.Raise(part, hn::Sub(hn::Sub(get(1, 0, part, 1), beside), along));
            if (y + 1 < counts[1])
            {
              yy.Raise(part,
                GetChange(
                  samples, 1, y, hn::Sub(get(2, 0, part, 0), beside), hn::Sub(beside, here)));
            }
          }
          if (z < counts[2])
          {
            const Vector above = get(0, 1, part, 0);
            xz.Raise(part, hn::Sub(hn::Sub(get(0, 1, part, 1), above), along));
            if (z + 1 < counts[2])
            {
              zz.Raise(part,
                GetChange(samples, 2, z, hn::Sub(get(0, 2, part, 0), above), hn::Sub(above, here)));
            }
            if (y < counts[1])
            {
              yz.Raise(part,
                hn::Sub(hn::Sub(get(1, 1, part, 0), above), hn::Sub(get(1, 0, part, 0), here)));
            }
          }
        }
      }
    }
    const float twice[3] = { xx.GetMost(counts[0] - 1), yy.GetMost(counts[0] + 1),
      zz.GetMost(counts[0] + 1) };
    const float mixed[3] = { xy.GetMost(counts[0]), xz.GetMost(counts[0]),
      yz.GetMost(counts[0] + 1) };
    return std::max({ twice[0] + mixed[0] + mixed[1], twice[1] + mixed[0] + mixed[2],
      twice[2] + mixed[1] + mixed[2] });
  }

private:
  /// The largest sizes so far.
  class Sizes
  {
  public:
    Sizes()
    {
      for (Vector& part : this->Parts)
      {
        part = hn::Zero(Tag());
      }
    }
    HWY_INLINE void Raise(int part, Vector change)
    {
      Vector& own = this->Parts[part / Width];
      own = hn::Max(own, hn::Abs(change));
    }
    /// Returns the largest of the first `count`.
    float GetMost(int count) const
    {
      HWY_ALIGN float sizes[RowSamples];
      for (int part = 0; part < RowSamples; part += Width)
      {
        hn::Store(this->Parts[part / Width], Tag(), sizes + part);
      }
      return count > 0 ? *std::max_element(sizes, sizes + count) : 0.0f;
    }

  private:
    Vector Parts[RowSamples / Width];
  };
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
