// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TetrahedronCrossing_h
#define rt_TetrahedronCrossing_h

#include "DSMRayTracing/ray/TriangleRay.h"

namespace rt
{

/// A point of a tetrahedron as a ray sees it, after Woop et al. 2013: the ray goes along the third axis, in units of
/// its T times Shear[2].
struct SeenPoint
{
  double X;
  double Y;
  double Depth;
  double Value;

  SeenPoint() = default;
  SeenPoint(const TriangleRay& ray, const float* point, float value)
    : Depth(point[ray.Axes[2]] - ray.Origin[2])
    , Value(value)
  {
    this->X = (point[ray.Axes[0]] - ray.Origin[0]) - ray.Shear[0] * this->Depth;
    this->Y = (point[ray.Axes[1]] - ray.Origin[1]) - ray.Shear[1] * this->Depth;
  }
};

/// Where a ray crosses the faces of a tetrahedron, and the values there.
struct TetrahedronCrossing
{
  double Enter; ///< T
  double Exit;  ///< T
  double First;
  double Last;

  /// False where the ray misses the tetrahedron. `points` are in the order that all tetrahedra have them in: what is
  /// found at a face comes from the same operations on both of its sides. As for triangles (TriangleIntersector.h), a
  /// ray does not pass between tetrahedra that share a face, an edge or a corner.
  bool Find(const TriangleRay& ray, const SeenPoint points[4])
  {
    const auto cross = [&](int one, int other)
    { return points[one].X * points[other].Y - points[one].Y * points[other].X; };
    const double edge01 = cross(0, 1);
    const double edge02 = cross(0, 2);
    const double edge03 = cross(0, 3);
    const double edge12 = cross(1, 2);
    const double edge13 = cross(1, 3);
    const double edge23 = cross(2, 3);
    this->Count = 0;
    this->AddFace(ray, points[0], points[1], points[2], edge12, -edge02, edge01);
    this->AddFace(ray, points[0], points[1], points[3], edge13, -edge03, edge01);
    this->AddFace(ray, points[0], points[2], points[3], edge23, -edge03, edge02);
    this->AddFace(ray, points[1], points[2], points[3], edge23, -edge13, edge12);
    return this->Count > 1;
  }

private:
  void AddFace(const TriangleRay& ray, const SeenPoint& a, const SeenPoint& b, const SeenPoint& c,
    double u, double v, double w)
  {
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0))
    {
      return;
    }
    const double determinant = u + v + w;
    if (determinant == 0.0)
    {
      return;
    }
    const double inverse = 1.0 / determinant;
    const double t = (u * a.Depth + v * b.Depth + w * c.Depth) * inverse * ray.Shear[2];
    const double value = (u * a.Value + v * b.Value + w * c.Value) * inverse;
    if (this->Count == 0 || t < this->Enter)
    {
      this->Enter = t;
      this->First = value;
    }
    if (this->Count == 0 || t > this->Exit)
    {
      this->Exit = t;
      this->Last = value;
    }
    ++this->Count;
  }

  int Count = 0;
};

} // namespace rt

#endif
