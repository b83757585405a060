// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TrilinearCell_h
#define rt_TrilinearCell_h

#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/Cubic.h"

namespace rt
{

/// (1 - u) a + u b: exactly a at 0 and b at 1.
inline double Interpolate(double a, double b, double u)
{
  return (1.0 - u) * a + u * b;
}

/// The trilinear function of a cell. Corners are numbered with x in bit 0, y in bit 1, z in bit 2.
/// On a face (a coordinate exactly 0 or 1) the value depends on the corners of that face only, and
/// is bit for bit the same in both cells that share it.
inline double EvaluateTrilinear(const double corners[8], const Lanes& point)
{
  const double x00 = Interpolate(corners[0], corners[1], point[0]);
  const double x10 = Interpolate(corners[2], corners[3], point[0]);
  const double x01 = Interpolate(corners[4], corners[5], point[0]);
  const double x11 = Interpolate(corners[6], corners[7], point[0]);
  return Interpolate(Interpolate(x00, x10, point[1]), Interpolate(x01, x11, point[1]), point[2]);
}

/// How fast it grows on each axis.
inline void DifferentiateTrilinear(const double corners[8], const Lanes& point, double gradient[3])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int first = axis == 0 ? 1 : 0;
    const int second = axis == 2 ? 1 : 2;
    double edges[4];
    for (int edge = 0; edge < 4; ++edge)
    {
      const int corner = (edge & 1) << first | (edge >> 1) << second;
      edges[edge] = corners[corner | 1 << axis] - corners[corner];
    }
    gradient[axis] = Interpolate(Interpolate(edges[0], edges[1], point[first]),
      Interpolate(edges[2], edges[3], point[first]), point[second]);
  }
}

/// The cubic that the trilinear function is at start + s direction. The constant term is EvaluateTrilinear(corners,
/// start), bit for bit.
inline Cubic GetCubic(const double corners[8], const Lanes& start, const Lanes& direction)
{
  Cubic cubic;
  double linear[4][2];
  for (int edge = 0; edge < 4; ++edge)
  {
    const double a = corners[2 * edge];
    const double b = corners[2 * edge + 1];
    linear[edge][0] = Interpolate(a, b, start[0]);
    linear[edge][1] = direction[0] * (b - a);
  }
  double quadratic[2][3];
  for (int face = 0; face < 2; ++face)
  {
    const double* a = linear[2 * face];
    const double* b = linear[2 * face + 1];
    quadratic[face][0] = Interpolate(a[0], b[0], start[1]);
    quadratic[face][1] = Interpolate(a[1], b[1], start[1]) + direction[1] * (b[0] - a[0]);
    quadratic[face][2] = direction[1] * (b[1] - a[1]);
  }
  const double* a = quadratic[0];
  const double* b = quadratic[1];
  cubic.Coefficients[0] = Interpolate(a[0], b[0], start[2]);
  cubic.Coefficients[1] = Interpolate(a[1], b[1], start[2]) + direction[2] * (b[0] - a[0]);
  cubic.Coefficients[2] = Interpolate(a[2], b[2], start[2]) + direction[2] * (b[1] - a[1]);
  cubic.Coefficients[3] = direction[2] * (b[2] - a[2]);
  return cubic;
}

} // namespace rt

#endif
