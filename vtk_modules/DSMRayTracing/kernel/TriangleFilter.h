// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TriangleFilter_h
#define rt_TriangleFilter_h

#include "DSMRayTracing/brick/TriangleBrick.h"
#include "DSMRayTracing/kernel/Float4.h"
#include "DSMRayTracing/kernel/MeshRay.h"

namespace rt
{

/// Tells four triangles at a time which of them the ray certainly misses; IntersectTriangle decides
/// on the others. It is the same test in single precision, with room for its errors, so it never
/// drops a triangle that is hit. `Axis` is the one along which the ray moves most.
///
/// Errors: with d the uncertainty of a coordinate relative to the ray, and e the largest extent of
/// a triangle, the corners of a triangle that is hit lie within 2 e of the ray, and each is known to
/// within 2 d after the shear. An edge function, a difference of two products, is then off by at
/// most 16 d e + 8 d^2 plus the rounding of the products, 16 e^2 2^-24.
template <int Axis>
class TriangleFilter
{
public:
  TriangleFilter(const MeshRay& ray, const TriangleBrick& brick)
    : Brick(brick)
    , Vertices(brick.GetVertices())
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Origin[axis] = Float4::Fill(ray.Boxes.Origin[axis]);
    }
    this->ShearX = Float4::Fill(ray.FilterShear[0]);
    this->ShearY = Float4::Fill(ray.FilterShear[1]);
    const float d = ray.Uncertainty;
    const float e = brick.GetHeader().LargestExtent;
    const float error = 20.0f * d * e + 10.0f * d * d + 0x1p-19f * e * e;
    this->Positive = Float4::Fill(error);
    this->Negative = Float4::Fill(-error);
  }

  /// Bit i is set where triangle first + i may be hit; reads four triangles whatever their number.
  unsigned FindCandidates(std::uint32_t first) const
  {
    const std::uint16_t* corners = this->Brick.GetTriangle(first);
    Float4 x[3];
    Float4 y[3];
    for (int corner = 0; corner < 3; ++corner)
    {
      this->GetCorner(corners + corner, x[corner], y[corner]);
    }
    const Float4 u = x[2] * y[1] - y[2] * x[1];
    const Float4 v = x[0] * y[2] - y[0] * x[2];
    const Float4 w = x[1] * y[0] - y[1] * x[0];
    // Written so that what is not a number is a candidate.
    return ~GetBothLess(Min(Min(u, v), w), this->Negative, this->Positive, Max(Max(u, v), w));
  }

private:
  /// One corner of each triangle, sheared so that the ray is the origin of the plane.
  void GetCorner(const std::uint16_t* corners, Float4& x, Float4& y) const
  {
    Float4 position[3];
    Float4::LoadTransposed(this->Vertices[corners[0]].Position, this->Vertices[corners[3]].Position,
      this->Vertices[corners[6]].Position, this->Vertices[corners[9]].Position, position[0],
      position[1], position[2]);
    const Float4 z = position[Axis] - this->Origin[Axis];
    x = position[(Axis + 1) % 3] - this->Origin[(Axis + 1) % 3] - this->ShearX * z;
    y = position[(Axis + 2) % 3] - this->Origin[(Axis + 2) % 3] - this->ShearY * z;
  }

  TriangleBrick Brick;
  const TriangleBrickVertex* Vertices;
  Float4 Origin[3];
  Float4 ShearX;
  Float4 ShearY;
  Float4 Positive;
  Float4 Negative;
};

} // namespace rt

#endif
