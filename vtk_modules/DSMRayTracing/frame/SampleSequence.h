// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SampleSequence_h
#define rt_SampleSequence_h

#include <glm/vec2.hpp>

#include <cmath>
#include <cstdint>

namespace rt
{

/// The random numbers of one sample of one pixel: a function of pixel and sample alone, so that
/// pictures do not depend on who traces what, and when.
class SampleSequence
{
public:
  SampleSequence(int x, int y, int sample)
    : Sample(sample)
    , State(Mix(static_cast<std::uint32_t>(x) +
        Mix(static_cast<std::uint32_t>(y) + Mix(static_cast<std::uint32_t>(sample) + 1u))))
  {
  }

  /// Where in the pixel the sample lies, each in [0, 1): the first one in the centre, the others on
  /// the additive sequence of the plastic number (M. Roberts, 2018), which fills the pixel evenly.
  glm::dvec2 GetPositionInPixel() const
  {
    constexpr double StepX = 0.7548776662466927;
    constexpr double StepY = 0.5698402909980532;
    const double x = 0.5 + this->Sample * StepX;
    const double y = 0.5 + this->Sample * StepY;
    return { x - std::floor(x), y - std::floor(y) };
  }

  /// The next number, uniform in [0, 1).
  double Next()
  {
    this->State += 0x9e3779b9u;
    return Mix(this->State) * (1.0 / 4294967296.0);
  }

private:
  /// A 32-bit integer finaliser with low bias (C. Wellons, hash-prospector).
  static std::uint32_t Mix(std::uint32_t value)
  {
    value ^= value >> 16;
    value *= 0x7feb352du;
    value ^= value >> 15;
    value *= 0x846ca68bu;
    value ^= value >> 16;
    return value;
  }

  int Sample;
  std::uint32_t State;
};

} // namespace rt

#endif
