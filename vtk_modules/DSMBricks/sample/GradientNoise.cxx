// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/sample/GradientNoise.h"

#include <cmath>

namespace bricks
{

namespace
{

/// A 32-bit integer finalizer with low bias (C. Wellons, hash-prospector).
std::uint32_t Mix(std::uint32_t x)
{
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

double Fade(double t)
{
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

double Lerp(double a, double b, double t)
{
  return a + t * (b - a);
}

/// Dot product with one of twelve edge midpoints of a cube, the last four of sixteen repeated.
double DotGradient(std::uint32_t hash, double x, double y, double z)
{
  hash &= 15u;
  const double u = hash < 8u ? x : y;
  const double v = hash < 4u ? y : (hash == 12u || hash == 14u ? x : z);
  return ((hash & 1u) ? -u : u) + ((hash & 2u) ? -v : v);
}

/// The lattice cube around a point: the hashes of its corners and the position within.
class LatticeCube
{
public:
  LatticeCube(double x, double y, double z, std::uint32_t hashedSeed)
  {
    const double floorX = std::floor(x);
    const double floorY = std::floor(y);
    const double floorZ = std::floor(z);
    this->X = x - floorX;
    this->Y = y - floorY;
    this->Z = z - floorZ;
    const auto cornerX = static_cast<std::uint32_t>(static_cast<std::int64_t>(floorX));
    const auto cornerY = static_cast<std::uint32_t>(static_cast<std::int64_t>(floorY));
    const auto cornerZ = static_cast<std::uint32_t>(static_cast<std::int64_t>(floorZ));
    for (std::uint32_t k = 0; k < 2; ++k)
    {
      const std::uint32_t plane = Mix(cornerZ + k + hashedSeed);
      for (std::uint32_t j = 0; j < 2; ++j)
      {
        const std::uint32_t row = Mix(cornerY + j + plane);
        for (std::uint32_t i = 0; i < 2; ++i)
        {
          this->Hash[4 * k + 2 * j + i] = Mix(cornerX + i + row);
        }
      }
    }
  }

  /// `shift`: which bits of the hashes choose the gradients.
  double Interpolate(int shift) const
  {
    const double u = Fade(this->X);
    const double v = Fade(this->Y);
    const double w = Fade(this->Z);
    double plane[2];
    for (int k = 0; k < 2; ++k)
    {
      double row[2];
      for (int j = 0; j < 2; ++j)
      {
        const std::uint32_t* hash = this->Hash + 4 * k + 2 * j;
        row[j] = Lerp(DotGradient(hash[0] >> shift, this->X, this->Y - j, this->Z - k),
          DotGradient(hash[1] >> shift, this->X - 1.0, this->Y - j, this->Z - k), u);
      }
      plane[k] = Lerp(row[0], row[1], v);
    }
    return Lerp(plane[0], plane[1], w);
  }

private:
  double X;
  double Y;
  double Z;
  std::uint32_t Hash[8];
};

/// Sums `octave(noise)` over the octaves of a series.
template <class Octave>
double SumOctaves(const NoiseSeries& series, double x, double y, double z, Octave&& octave)
{
  double sum = 0.0;
  double amplitude = 1.0;
  double frequency = series.FirstFrequency;
  for (int o = 0; o < series.Octaves && frequency <= series.LargestFrequency; ++o)
  {
    const GradientNoise noise(series.FirstSeed + static_cast<std::uint32_t>(o));
    sum += amplitude * octave(noise.Evaluate(frequency * x, frequency * y, frequency * z));
    amplitude *= series.Gain;
    frequency *= 2.0;
  }
  return sum;
}

} // namespace

GradientNoise::GradientNoise(std::uint32_t seed)
  : HashedSeed(Mix(seed))
{
}

double GradientNoise::Evaluate(double x, double y, double z) const
{
  return LatticeCube(x, y, z, this->HashedSeed).Interpolate(0);
}

std::array<double, 3> GradientNoise::EvaluateThree(double x, double y, double z) const
{
  const LatticeCube cube(x, y, z, this->HashedSeed);
  return { cube.Interpolate(0), cube.Interpolate(4), cube.Interpolate(8) };
}

double NoiseSeries::EvaluateSum(double x, double y, double z) const
{
  return SumOctaves(*this, x, y, z, [](double noise) { return noise; });
}

double NoiseSeries::EvaluateBillow(double x, double y, double z) const
{
  return SumOctaves(*this, x, y, z, [](double noise) { return 3.0 * std::fabs(noise) - 1.0; });
}

} // namespace bricks
