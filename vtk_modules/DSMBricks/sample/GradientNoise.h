// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_GradientNoise_h
#define bricks_GradientNoise_h

#include <array>
#include <cstdint>

namespace bricks
{

/// Improved gradient noise (K. Perlin, SIGGRAPH 2002) on a hashed lattice, in about [-1, 1]. Only
/// IEEE-exact operations are used, so every rank computes the same bits.
class GradientNoise
{
public:
  explicit GradientNoise(std::uint32_t seed);

  double Evaluate(double x, double y, double z) const;

  /// Three uncorrelated values from one lattice; what a domain warp needs.
  std::array<double, 3> EvaluateThree(double x, double y, double z) const;

private:
  std::uint32_t HashedSeed;
};

/// A series of octaves, frequency doubling and amplitude falling by `Gain`; octaves above
/// `LargestFrequency`, which the grid cannot show, are left out.
struct NoiseSeries
{
  double FirstFrequency;
  double Gain;
  int Octaves;
  double LargestFrequency;
  /// Octave *o* uses the seed FirstSeed + o.
  std::uint32_t FirstSeed;

  /// Fractional Brownian motion: the plain sum.
  double EvaluateSum(double x, double y, double z) const;
  /// The sum of 3 |noise| - 1: round lobes between sharp creases.
  double EvaluateBillow(double x, double y, double z) const;
};

} // namespace bricks

#endif
