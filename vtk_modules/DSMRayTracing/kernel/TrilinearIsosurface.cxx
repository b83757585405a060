// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/kernel/TrilinearIsosurface.h"

#include <cmath>
#include <utility>

namespace rt
{

namespace
{

/// The cubic is monotone, or at least on different sides, at the ends of [low, high]: Newton's
/// method, kept within the bracket by bisection.
double Refine(const Cubic& cubic, double low, double high, bool lowInside)
{
  constexpr double tolerance = 1e-14;
  double s = 0.5 * (low + high);
  double lastStep = high - low;
  for (int iteration = 0; iteration < 100 && high - low > tolerance; ++iteration)
  {
    const double value = cubic.Evaluate(s);
    ((value >= 0.0) == lowInside ? low : high) = s;
    double next = s - value / cubic.EvaluateDerivative(s);
    // Bisect when Newton leaves the bracket, or does not converge at least as fast.
    if (!(next > low && next < high && std::abs(next - s) < 0.5 * lastStep))
    {
      next = 0.5 * (low + high);
    }
    lastStep = std::abs(next - s);
    s = next;
    if (lastStep <= tolerance)
    {
      break;
    }
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

/// The places in (0, 1) where the derivative vanishes, ascending; returns how many.
int FindExtrema(const Cubic& cubic, double extrema[2])
{
  const double a = 3.0 * cubic.Coefficients[3];
  const double b = cubic.Coefficients[2];
  const double c = cubic.Coefficients[1];
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

} // namespace

bool FindFirstCrossing(
  const double corners[8], const double start[3], const double end[3], double& s)
{
  const double direction[3] = { end[0] - start[0], end[1] - start[1], end[2] - start[2] };
  const Cubic cubic(corners, start, direction);
  const double last = EvaluateTrilinear(corners, end);
  const bool startInside = cubic.Coefficients[0] >= 0.0;
  const bool endInside = last >= 0.0;
  const int changes = CountSignChanges(cubic, last);
  if (changes == 0)
  {
    return false;
  }
  double low = 0.0;
  if (changes > 1)
  {
    double extrema[2];
    const int count = FindExtrema(cubic, extrema);
    for (int i = 0; i < count; ++i)
    {
      if ((cubic.Evaluate(extrema[i]) >= 0.0) != startInside)
      {
        s = Refine(cubic, low, extrema[i], startInside);
        return true;
      }
      low = extrema[i];
    }
  }
  if (startInside == endInside)
  {
    return false;
  }
  s = Refine(cubic, low, 1.0, startInside);
  return true;
}

} // namespace rt
