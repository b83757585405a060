// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SampleSequence_h
#define rt_SampleSequence_h

#include <glm/vec2.hpp>

#include <cmath>
#include <cstdint>

namespace rt
{

/// The random numbers of one sample of one pixel: a function of pixel and sample alone, so that
/// pictures do not depend on who traces what, and when. Squares of sixteen pixels have different ones (Keller and
/// Heidrich, Interleaved Sampling, 2001): together, they know as much as sixteen samples of a pixel.
class SampleSequence
{
public:
  SampleSequence() = default;
  SampleSequence(int x, int y, int sample)
    : Sample(sample)
    , Pixel(Mix(static_cast<std::uint32_t>(x) + Mix(static_cast<std::uint32_t>(y) + 1u)))
    , Square(Mix(static_cast<std::uint32_t>(x) / 4 + Mix(static_cast<std::uint32_t>(y) / 4 + 1u)))
    , Stratum(GetStratum(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)))
  {
  }

  /// Returns the position of a sample in any pixel, each coordinate in [0, 1). The first one is in
  /// the center; the others follow the additive sequence of the plastic number (M. Roberts, 2018),
  /// which fills the pixel evenly.
  static glm::dvec2 GetPositionInPixel(int sample)
  {
    constexpr double StepX = 0.7548776662466927;
    constexpr double StepY = 0.5698402909980532;
    const double x = 0.5 + sample * StepX;
    const double y = 0.5 + sample * StepY;
    return { x - std::floor(x), y - std::floor(y) };
  }

  /// Returns the next number, uniform in [0, 1). For successive samples of a pixel, the n-th numbers fill the
  /// interval evenly, and the n-th pairs of numbers the square (steps of Richtmyer's sequence). So do the starts of
  /// 4 x 4 pixels; within their part of the interval they are pseudorandom.
  double Next()
  {
    constexpr double Steps[2] = { 0.4142135623730951, 0.7320508075688772 }; // of sqrt(2), sqrt(3)
    const std::uint32_t number = this->Numbers++;
    // The pixels change places from square to square, and from pair to pair of numbers: patterns would be seen.
    const std::uint32_t stratum =
      this->Stratum ^ (Mix(this->Square + (number / 2) * 0x9e3779b9u) >> 28);
    const std::uint32_t part = number % 2 == 0 ? stratum : Reverse(stratum);
    const double within = Mix(this->Pixel + number * 0x9e3779b9u) * (1.0 / 4294967296.0);
    const double start = (part + within) * (1.0 / 16.0);
    const double value = start + this->Sample * Steps[number % 2];
    return value - std::floor(value);
  }

private:
  /// Four bits in the opposite order.
  static std::uint32_t Reverse(std::uint32_t bits)
  {
    return (bits & 1) << 3 | (bits & 2) << 1 | (bits & 4) >> 1 | (bits & 8) >> 3;
  }

  /// A number below 16, another for each of 4 x 4 pixels: the next ones to each other are far apart (Bayer's matrix).
  static std::uint32_t GetStratum(std::uint32_t x, std::uint32_t y)
  {
    const std::uint32_t mixed = x ^ y;
    return Reverse((mixed & 1) | (y & 1) << 1 | (mixed & 2) << 1 | (y & 2) << 2);
  }

  /// A 32-bit integer finalizer with low bias (C. Wellons, hash-prospector).
  static std::uint32_t Mix(std::uint32_t value)
  {
    value ^= value >> 16;
    value *= 0x7feb352du;
    value ^= value >> 15;
    value *= 0x846ca68bu;
    value ^= value >> 16;
    return value;
  }

  int Sample = 0;
  std::uint32_t Pixel = 0;
  std::uint32_t Square = 0;
  std::uint32_t Stratum = 0;
  std::uint32_t Numbers = 0;
};

} // namespace rt

#endif
