// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PackedGradient_h
#define bricks_PackedGradient_h

#include "DSMBricks/layout/OctahedralNormal.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace bricks
{

/// A gradient in 32 bits: its direction on the unit octahedron, 11 bits a side (OctahedralNormal), and its length to
/// 5 % in 10 bits, from 2^-64 to 2^63. Zero: no gradient, or one that is shorter.
class PackedGradient
{
public:
  PackedGradient() = default;
  /// Zero where the gradient is not finite.
  explicit PackedGradient(const double gradient[3]);

  /// Writes the gradient; 0 if there is none.
  void Unpack(double gradient[3]) const;

private:
  static constexpr double Middle = 1023.0;
  static constexpr double StepsPerOctave = 8.0;
  static constexpr double One = 512.0; ///< steps of the length 1

  std::uint32_t Bits = 0;
};

static_assert(sizeof(PackedGradient) == 4, "bricks have one for each corner");

inline PackedGradient::PackedGradient(const double gradient[3])
{
  const double length = std::hypot(gradient[0], gradient[1], gradient[2]);
  if (!(length > 0.0) || !std::isfinite(length))
  {
    return;
  }
  const double steps = std::round(StepsPerOctave * std::log2(length)) + One;
  if (steps < 1.0)
  {
    return;
  }
  const double sum = std::abs(gradient[0]) + std::abs(gradient[1]) + std::abs(gradient[2]);
  double u = gradient[0] / sum;
  double v = gradient[1] / sum;
  if (gradient[2] < 0.0)
  {
    const double folded = (1.0 - std::abs(v)) * (u < 0.0 ? -1.0 : 1.0);
    v = (1.0 - std::abs(u)) * (v < 0.0 ? -1.0 : 1.0);
    u = folded;
  }
  const auto quantize = [](double x)
  {
    return static_cast<std::uint32_t>(
      std::clamp(std::round(x * Middle + Middle), 0.0, 2.0 * Middle));
  };
  this->Bits =
    static_cast<std::uint32_t>(std::min(steps, 1023.0)) << 22 | quantize(u) << 11 | quantize(v);
}

inline void PackedGradient::Unpack(double gradient[3]) const
{
  const std::uint32_t steps = this->Bits >> 22;
  const double u = ((this->Bits >> 11 & 0x7ffu) - Middle) / Middle;
  const double v = ((this->Bits & 0x7ffu) - Middle) / Middle;
  double way[3] = { u, v, 1.0 - std::abs(u) - std::abs(v) };
  const double fold = std::max(-way[2], 0.0);
  way[0] += u < 0.0 ? fold : -fold;
  way[1] += v < 0.0 ? fold : -fold;
  const double size = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  const double length =
    steps == 0 ? 0.0 : std::exp2((static_cast<double>(steps) - One) / StepsPerOctave) / size;
  for (int axis = 0; axis < 3; ++axis)
  {
    gradient[axis] = way[axis] * length;
  }
}

} // namespace bricks

#endif
