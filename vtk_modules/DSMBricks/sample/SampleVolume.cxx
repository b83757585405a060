// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/sample/SampleVolume.h"

#include "DSMBricks/sample/GradientNoise.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace bricks
{

namespace
{

/// A parabola in place of |sin(pi t)|: 0 at the integers, 1 between them.
double Arch(double t)
{
  const double fraction = t - std::floor(t);
  return 4.0 * fraction * (1.0 - fraction);
}

// The mixing layer's parameters. Lengths are fractions of the x axis.
constexpr std::uint32_t Seed = 225;
constexpr double HalfThickness = 0.42;
constexpr double MeshWires = 7.0;
constexpr double FrontAmplitude = 0.15;
constexpr double Overhang = 0.8;
constexpr double InterfaceThickness = 0.030;
constexpr double OctaveGain = 0.60;
constexpr int OctaveCount = 8;
constexpr double CoarseWarp = 0.05;
constexpr double CoarseFrequency = 3.0;
constexpr double FineWarp = 0.022;
constexpr double FineFrequency = 12.0;
constexpr double BillowAmplitude = 0.055;
constexpr double BillowFrequency = 8.0;
constexpr double RippleAmplitude = 0.022;
constexpr double RippleFrequency = 16.0;

/// Moves a point by two octaves of vector noise: the roll-up of the layer.
glm::dvec3 Warp(
  const glm::dvec3& point, const glm::dvec3& at, double amount, double f, std::uint32_t seed)
{
  const auto low = GradientNoise(seed).EvaluateThree(f * at.x, f * at.y, f * at.z);
  const double g = 2.0 * f;
  const auto high = GradientNoise(seed + 1).EvaluateThree(g * at.x, g * at.y, g * at.z);
  return { point.x + amount * (low[0] + 0.5 * high[0]), point.y + amount * (low[1] + 0.5 * high[1]),
    point.z + amount * (low[2] + 0.5 * high[2]) };
}

template <class T>
T ToSample(double value, double integerScale)
{
  if constexpr (std::is_integral_v<T>)
  {
    const double largest = std::min<double>(255.0, std::numeric_limits<T>::max());
    return static_cast<T>(std::floor(std::clamp(value * integerScale, 0.0, largest) + 0.5));
  }
  else
  {
    return static_cast<T>(value);
  }
}

} // namespace

SampleVolume::SampleVolume(Kind kind, const Index3& points)
  : Type(kind)
  , Points(points)
{
}

double SampleVolume::GetSpacing() const
{
  const auto longest = std::max({ this->Points.x, this->Points.y, this->Points.z });
  return this->Type == Kind::MixingLayer ? 1.0 / static_cast<double>(this->Points.x)
                                         : 2.0 / static_cast<double>(longest);
}

glm::dvec3 SampleVolume::GetOrigin() const
{
  const double spacing = this->GetSpacing();
  const glm::dvec3 centred = (glm::dvec3(0.5) - 0.5 * glm::dvec3(this->Points)) * spacing;
  return this->Type == Kind::MixingLayer ? glm::dvec3(0.5 * spacing, 0.5 * spacing, centred.z)
                                         : centred;
}

double SampleVolume::Evaluate(std::int64_t i, std::int64_t j, std::int64_t k) const
{
  if (this->Type == Kind::Sphere)
  {
    return this->EvaluateSphere(i, j, k);
  }
  const double inverse = 1.0 / static_cast<double>(this->Points.x);
  const double u = this->EvaluateMixingLayer(
    (i + 0.5) * inverse, (j + 0.5) * inverse, (k + 0.5 - 0.5 * this->Points.z) * inverse);
  return 127.5 + 127.5 * u;
}

double SampleVolume::EvaluateSphere(std::int64_t i, std::int64_t j, std::int64_t k) const
{
  const auto longest = std::max({ this->Points.x, this->Points.y, this->Points.z });
  const double scale = 2.0 / static_cast<double>(longest);
  const double x = (i + 0.5 - 0.5 * this->Points.x) * scale;
  const double y = (j + 0.5 - 0.5 * this->Points.y) * scale;
  const double z = (k + 0.5 - 0.5 * this->Points.z) * scale;
  const NoiseSeries noise{ 2.5, 0.5, 6, static_cast<double>(longest) / 8.0, Seed + 901 };
  return x * x + y * y + z * z + 0.22 * noise.EvaluateSum(x, y, z);
}

double SampleVolume::EvaluateMixingLayer(double x, double y, double z) const
{
  const double relative = z / HalfThickness;
  double envelope = 1.0 - relative * relative;
  envelope = envelope > 0.0 ? envelope * envelope : 0.0;

  glm::dvec3 p(x, y, z);
  double turbulence = 0.0;
  if (envelope > 0.0)
  {
    p = Warp(p, p, CoarseWarp * envelope, CoarseFrequency, Seed + 101);
    p = Warp(p, p, FineWarp * envelope, FineFrequency, Seed + 111);
    const auto longest = std::max({ this->Points.x, this->Points.y, this->Points.z });
    const double finest = static_cast<double>(longest) / 4.0;
    const NoiseSeries billow{ BillowFrequency, OctaveGain, OctaveCount, finest, Seed + 201 };
    const NoiseSeries ripple{ RippleFrequency, OctaveGain, OctaveCount, finest, Seed + 301 };
    turbulence = envelope *
      (BillowAmplitude * billow.EvaluateBillow(p.x, p.y, p.z) +
        RippleAmplitude * ripple.EvaluateSum(p.x, p.y, p.z));
  }

  // The initial perturbation has two scales: the wires of a mesh, and a slow change of amplitude.
  const double jitterX = 0.35 * GradientNoise(Seed + 2).Evaluate(2.3 * p.x, 2.3 * p.y, 0.11);
  const double jitterY = 0.35 * GradientNoise(Seed + 3).Evaluate(2.3 * p.x, 2.3 * p.y, 0.73);
  const double mesh = std::sqrt(Arch(MeshWires * p.x + jitterX) * Arch(MeshWires * p.y + jitterY));
  const double slow = 1.0 + 0.9 * GradientNoise(Seed + 1).Evaluate(1.7 * p.x, 1.7 * p.y, 0.37);
  const double amplitude = FrontAmplitude * std::max(slow, 0.35);

  // Overhanging caps on narrow stems, bubbles and spikes alike.
  const double q = std::clamp(p.z / amplitude, -2.0, 2.0);
  const double q2 = q * q;
  const double cap = 0.5 + 0.5 * q * ((1.0 + Overhang) * q2 * q2 - Overhang);
  const double u = (0.9 * amplitude * (cap - mesh) - turbulence) / InterfaceThickness;
  return u / std::sqrt(1.0 + u * u);
}

void SampleVolume::Fill(const Box& points, ScalarType type, std::byte* out) const
{
  const double integerScale = this->Type == Kind::Sphere ? 64.0 : 1.0;
  Dispatch(type,
    [&](auto sample)
    {
      using T = decltype(sample);
      for (auto k = points.Min.z; k < points.Max.z; ++k)
      {
        for (auto j = points.Min.y; j < points.Max.y; ++j)
        {
          for (auto i = points.Min.x; i < points.Max.x; ++i)
          {
            const T value = ToSample<T>(this->Evaluate(i, j, k), integerScale);
            std::memcpy(out, &value, sizeof(T));
            out += sizeof(T);
          }
        }
      }
    });
}

} // namespace bricks
