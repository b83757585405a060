// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_MortonCode_h
#define bricks_MortonCode_h

#include <algorithm>
#include <cstdint>

namespace bricks
{

/// Numbers the places of a cube along a space-filling curve: the bits of the three coordinates in
/// turn, so that places with a common beginning lie in one octant, half or quarter octant.
class MortonCode
{
public:
  static constexpr int BitsPerAxis = 21;
  static constexpr int Bits = 3 * BitsPerAxis;

  MortonCode() = default;
  /// The cube over [lower, lower + edge]; an edge of 0 puts everything at code 0.
  MortonCode(const float lower[3], double edge)
    : Scale(edge > 0.0 ? (std::uint32_t(1) << BitsPerAxis) / edge : 0.0)
  {
    std::copy_n(lower, 3, this->Lower);
  }

  /// Returns the code of a place. Places outside of the cube are moved to its border.
  std::uint64_t Get(const double place[3]) const
  {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double number = std::clamp((place[axis] - this->Lower[axis]) * this->Scale, 0.0,
        (std::uint32_t(1) << BitsPerAxis) - 1.0);
      code |= Spread(static_cast<std::uint64_t>(number)) << axis;
    }
    return code;
  }
  /// Returns the code of the centroid of a triangle with nine coordinates.
  std::uint64_t GetOfTriangle(const float corners[9]) const
  {
    double center[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      center[axis] =
        (static_cast<double>(corners[axis]) + corners[3 + axis] + corners[6 + axis]) * (1.0 / 3.0);
    }
    return this->Get(center);
  }

private:
  /// Two zero bits behind each of the lower 21.
  static std::uint64_t Spread(std::uint64_t x)
  {
    x = (x | x << 32) & 0x001f00000000ffffu;
    x = (x | x << 16) & 0x001f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
  }

  float Lower[3] = { 0.0f, 0.0f, 0.0f };
  double Scale = 0.0;
};

} // namespace bricks

#endif
