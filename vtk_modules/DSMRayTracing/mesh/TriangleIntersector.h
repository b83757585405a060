// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TriangleIntersector_h
#define rt_TriangleIntersector_h

#include "DSMRayTracing/mesh/TriangleHit.h"
#include "DSMRayTracing/ray/TriangleRay.h"

namespace rt
{

/// The watertight test of Woop, Benthin and Wald (JCGT 2013), all in double precision. A ray does not pass between
/// triangles that share an edge or a corner bit for bit: a corner is moved to the ray's space by itself, and the
/// sign of an edge is the same for both triangles. Where rounding makes an edge function zero the edge counts as
/// hit from both sides, so the paper's second try in higher precision is not needed: its errors would be holes,
/// ours is a hit that is off by less than the rounding of a coordinate.
///
/// False for triangles without area as seen along the ray. Not for hits before ray.Min or behind
/// ray.Max. Fills in all of the hit but Triangle.
inline bool IntersectTriangle(
  const TriangleRay& ray, const float* a, const float* b, const float* c, TriangleHit& hit)
{
  const int x = ray.Axes[0];
  const int y = ray.Axes[1];
  const int z = ray.Axes[2];
  const double az = a[z] - ray.Origin[2];
  const double bz = b[z] - ray.Origin[2];
  const double cz = c[z] - ray.Origin[2];
  const double ax = (a[x] - ray.Origin[0]) - ray.Shear[0] * az;
  const double ay = (a[y] - ray.Origin[1]) - ray.Shear[1] * az;
  const double bx = (b[x] - ray.Origin[0]) - ray.Shear[0] * bz;
  const double by = (b[y] - ray.Origin[1]) - ray.Shear[1] * bz;
  const double cx = (c[x] - ray.Origin[0]) - ray.Shear[0] * cz;
  const double cy = (c[y] - ray.Origin[1]) - ray.Shear[1] * cz;
  const double u = cx * by - cy * bx;
  const double v = ax * cy - ay * cx;
  const double w = bx * ay - by * ax;
  if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0))
  {
    return false;
  }
  const double determinant = u + v + w;
  if (determinant == 0.0)
  {
    return false;
  }
  const double inverse = 1.0 / determinant;
  const double t = (u * az + v * bz + w * cz) * inverse * ray.Shear[2];
  if (!(t >= ray.Min && t <= ray.Max))
  {
    return false;
  }
  hit.T = t;
  hit.Weights[0] = u * inverse;
  hit.Weights[1] = v * inverse;
  hit.Weights[2] = w * inverse;
  hit.Front = determinant > 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    hit.Corners[0][axis] = a[axis];
    hit.Corners[1][axis] = b[axis];
    hit.Corners[2][axis] = c[axis];
  }
  return true;
}

} // namespace rt

#endif
