// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_OctahedralNormal_h
#define bricks_OctahedralNormal_h

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bricks
{

/// A direction in 32 bits: the unit octahedron unfolded to a square, 16 bits a side (Meyer et al.
/// 2010; Cigolle et al., JCGT 2014). Within 0.003 degrees of the direction that was packed.
struct OctahedralNormal
{
  /// Stands for no direction. No direction packs to it: the coordinates go to 65534 only, so that
  /// the square has a middle and the axes are exact.
  static constexpr std::uint32_t None = 0xffffffffu;

  /// None when the normal is zero or not finite.
  static std::uint32_t Pack(const double normal[3])
  {
    const double sum = std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]);
    if (!(sum > 0.0) || !std::isfinite(sum))
    {
      return None;
    }
    double u = normal[0] / sum;
    double v = normal[1] / sum;
    if (normal[2] < 0.0)
    {
      const double folded = (1.0 - std::abs(v)) * (u < 0.0 ? -1.0 : 1.0);
      v = (1.0 - std::abs(u)) * (v < 0.0 ? -1.0 : 1.0);
      u = folded;
    }
    const auto quantise = [](double x)
    {
      return static_cast<std::uint32_t>(
        std::clamp(std::floor(x * Middle + Middle + 0.5), 0.0, 2.0 * Middle));
    };
    return quantise(u) | quantise(v) << 16;
  }

  /// Not of unit length. Not for None.
  static void Unpack(std::uint32_t packed, float normal[3])
  {
    constexpr auto scale = static_cast<float>(1.0 / Middle);
    const float u = static_cast<float>(packed & 0xffffu) * scale - 1.0f;
    const float v = static_cast<float>(packed >> 16) * scale - 1.0f;
    normal[2] = 1.0f - std::abs(u) - std::abs(v);
    const float fold = std::max(-normal[2], 0.0f);
    normal[0] = u < 0.0f ? u + fold : u - fold;
    normal[1] = v < 0.0f ? v + fold : v - fold;
  }

private:
  static constexpr double Middle = 32767.0;
};

} // namespace bricks

#endif
