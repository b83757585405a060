// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/Cubic.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace rt
{

namespace
{

/// One end of a bracket.
struct End
{
  double S;
  double Value;
};

/// The crossing between two places of different sides: Newton's method from where the chord
/// crosses, kept within the bracket by bisection.
double Refine(const Cubic& cubic, const End& begin, const End& end)
{
  // Newton squares the error, so after a step this small hardly anything is left of it.
  constexpr double tolerance = 1e-7;
  const bool beginInside = begin.Value >= 0.0;
  const auto isBefore = [&](double place) { return (cubic.Evaluate(place) >= 0.0) == beginInside; };
  double low = begin.S;
  double high = end.S;
  // A root is not enough: the values may touch zero at the beginning, and cross it later.
  const auto isCrossing = [&](double place)
  {
    return (place - tolerance <= low || isBefore(place - tolerance)) &&
      (place + tolerance >= high || !isBefore(place + tolerance));
  };
  // Not at the ends themselves: where the values are zero there, Newton would stay.
  const double chord = begin.Value / (begin.Value - end.Value);
  double s = low + (high - low) * std::clamp(chord, 0.015625, 0.984375);
  double lastStep = high - low;
  while (high - low > tolerance)
  {
    const double value = cubic.Evaluate(s);
    ((value >= 0.0) == beginInside ? low : high) = s;
    const double next = s - value / cubic.EvaluateDerivative(s);
    const double step = std::abs(next - s);
    if (step <= tolerance && isCrossing(next))
    {
      return std::clamp(next, low, high);
    }
    // Bisect when Newton leaves the bracket, or does not halve its steps.
    const bool newton = next > low && next < high && step > tolerance && step < 0.5 * lastStep;
    s = newton ? next : 0.5 * (low + high);
    lastStep = newton ? step : high - low;
  }
  return s;
}

/// Signs of the four Bernstein coefficients over [0, 1]: the curve has no more crossings than they
/// have changes.
int CountSignChanges(const Cubic& cubic, double last)
{
  const double* c = cubic.Coefficients;
  const bool inside[4] = { c[0] >= 0.0, c[0] + c[1] * (1.0 / 3.0) >= 0.0,
    c[0] + (2.0 * c[1] + c[2]) * (1.0 / 3.0) >= 0.0, last >= 0.0 };
  return static_cast<int>(inside[0] != inside[1]) + static_cast<int>(inside[1] != inside[2]) +
    static_cast<int>(inside[2] != inside[3]);
}

/// The power of two that brings `largest` (>= 0) to about one.
double GetScale(double largest)
{
  const double bounded = std::min(largest, 0x1p1022);
  std::uint64_t bits;
  std::memcpy(&bits, &bounded, sizeof(bits));
  constexpr int fraction = 52;
  constexpr std::uint64_t exponent = std::uint64_t{ 0x7ff } << fraction;
  bits = (std::uint64_t{ 2 * 1023 } << fraction) - (bits & exponent);
  double scale;
  std::memcpy(&scale, &bits, sizeof(scale));
  return scale;
}

/// Two places of different sides between which the first crossing is; false when there is none.
/// `last`: the value at 1.
bool FindBracket(const Cubic& cubic, double last, End& begin, End& end)
{
  const bool startInside = cubic.Coefficients[0] >= 0.0;
  const bool endInside = last >= 0.0;
  const int changes = CountSignChanges(cubic, last);
  if (changes == 0)
  {
    return false;
  }
  begin = { 0.0, cubic.Coefficients[0] };
  if (changes > 1)
  {
    double extrema[2];
    const int count = FindExtrema(cubic, extrema);
    for (int i = 0; i < count; ++i)
    {
      end = { extrema[i], cubic.Evaluate(extrema[i]) };
      if ((end.Value >= 0.0) != startInside)
      {
        return true;
      }
      begin = end;
    }
  }
  end = { 1.0, last };
  return startInside != endInside;
}

} // namespace

int FindExtrema(const Cubic& cubic, double extrema[2])
{
  // Squares of the coefficients may be too small or too large for numbers; of exact multiples of
  // them they are not, and the places are the same.
  const double* coefficients = cubic.Coefficients;
  const double scale = GetScale(std::max(
    std::abs(coefficients[3]), std::max(std::abs(coefficients[2]), std::abs(coefficients[1]))));
  const double a = 3.0 * (scale * coefficients[3]);
  const double b = scale * coefficients[2];
  const double c = scale * coefficients[1];
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0.0))
  {
    return 0;
  }
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  double first = q / a;
  double second = c / q;
  if (second < first)
  {
    std::swap(first, second);
  }
  int count = 0;
  for (const double place : { first, second })
  {
    if (place > 0.0 && place < 1.0)
    {
      extrema[count++] = place;
    }
  }
  return count;
}

bool FindFirstCrossing(const Cubic& cubic, double last, double& s)
{
  End before;
  End after;
  if (!FindBracket(cubic, last, before, after))
  {
    return false;
  }
  s = Refine(cubic, before, after);
  return true;
}

int CountCrossings(const Cubic& cubic, double last)
{
  bool inside = cubic.Coefficients[0] >= 0.0;
  int crossings = 0;
  const auto pass = [&](double value)
  {
    crossings += (value >= 0.0) != inside;
    inside = value >= 0.0;
  };
  if (CountSignChanges(cubic, last) > 1)
  {
    double extrema[2];
    const int count = FindExtrema(cubic, extrema);
    for (int i = 0; i < count; ++i)
    {
      pass(cubic.Evaluate(extrema[i]));
    }
  }
  pass(last);
  return crossings;
}

bool HasCrossing(const Cubic& cubic, double last)
{
  End before;
  End after;
  return FindBracket(cubic, last, before, after);
}

} // namespace rt
