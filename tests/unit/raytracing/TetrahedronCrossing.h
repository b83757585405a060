// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_TetrahedronCrossing_h
#define tests_TetrahedronCrossing_h

#include "DSMRayTracing/ray/TriangleRay.h"

#include <algorithm>
#include <limits>

/// rt::TetrahedronCrossings for one ray and one tetrahedron: what vectors have to find.
struct SeenPoint
{
  double X;
  double Y;
  double Depth;
  double Value;

  void Set(const rt::TriangleRay& ray, const float* point, float value)
  {
    this->Depth = point[ray.Axes[2]] - ray.Origin[2];
    this->X = (point[ray.Axes[0]] - ray.Origin[0]) - ray.Shear[0] * this->Depth;
    this->Y = (point[ray.Axes[1]] - ray.Origin[1]) - ray.Shear[1] * this->Depth;
    this->Value = value;
  }
};

/// Where a ray crosses the faces of a tetrahedron, and the values there.
class TetrahedronCrossing
{
public:
  double Enter = std::numeric_limits<double>::infinity(); ///< T
  double Exit = -std::numeric_limits<double>::infinity(); ///< T
  double First = 0.0;                                     ///< the value at Enter
  double Last = 0.0;                                      ///< at Exit

  /// Once. False where the ray misses the tetrahedron.
  bool Find(const rt::TriangleRay& ray, const SeenPoint& a, const SeenPoint& b, const SeenPoint& c,
    const SeenPoint& d)
  {
    const double ab = Cross(a, b);
    const double ac = Cross(a, c);
    const double ad = Cross(a, d);
    const double bc = Cross(b, c);
    const double bd = Cross(b, d);
    const double cd = Cross(c, d);
    this->AddFace(ray, a, b, c, bc, -ac, ab);
    this->AddFace(ray, a, b, d, bd, -ad, ab);
    this->AddFace(ray, a, c, d, cd, -ad, ac);
    this->AddFace(ray, b, c, d, cd, -bd, bc);
    return this->Faces > 1;
  }

private:
  static double Cross(const SeenPoint& one, const SeenPoint& other)
  {
    return one.X * other.Y - one.Y * other.X;
  }

  /// Does not depend on the order of the numbers. If all are negated, so is the sum.
  static double Add(double a, double b, double c)
  {
    const double less = std::min(a, b);
    const double more = std::max(a, b);
    const double middle = std::max(less, std::min(more, c));
    return (std::min(less, c) + std::max(more, c)) + middle;
  }

  void AddFace(const rt::TriangleRay& ray, const SeenPoint& a, const SeenPoint& b,
    const SeenPoint& c, double u, double v, double w)
  {
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0))
    {
      return;
    }
    const double determinant = Add(u, v, w);
    if (determinant == 0.0)
    {
      return;
    }
    const double inverse = 1.0 / determinant;
    const double t = Add(u * a.Depth, v * b.Depth, w * c.Depth) * inverse * ray.Shear[2];
    // Rounding may not leave the face's values: of three equal ones it is that.
    const double value = std::clamp(Add(u * a.Value, v * b.Value, w * c.Value) * inverse,
      std::min(std::min(a.Value, b.Value), c.Value), std::max(std::max(a.Value, b.Value), c.Value));
    if (t < this->Enter)
    {
      this->Enter = t;
      this->First = value;
    }
    if (t > this->Exit)
    {
      this->Exit = t;
      this->Last = value;
    }
    ++this->Faces;
  }

  int Faces = 0;
};

#endif
