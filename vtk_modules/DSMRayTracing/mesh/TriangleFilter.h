// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TriangleFilter_h
#define rt_TriangleFilter_h

#include "DSMBricks/base/Float4.h"
#include "DSMBricks/layout/TriangleBrick.h"

#include <cstdint>

namespace rt
{

/// Single precision numbers of a ray that TriangleFilter needs: its start, the shear along the two
/// axes that follow the filter's in turn, and how far off an edge function may be.
struct FilterRay
{
  float Origin[3];
  float Shear[2];
  float Error;

  /// `uncertainty`: see ShearedRay.
  static float GetError(float uncertainty, const bricks::TriangleBrick& brick)
  {
    const float d = uncertainty;
    const float e = brick.GetHeader().LargestExtent;
    return 20.0f * d * e + 10.0f * d * d + 0x1p-19f * e * e;
  }
};

/// Finds out which of four triangles a ray certainly misses; IntersectTriangle decides on the others. It is the
/// same test in single precision, with room for its errors, so it never drops a triangle that is hit. `Axis` is the
/// one along which the ray moves most. Made once for all rays that come to the triangles.
///
/// Errors: d is the uncertainty of a coordinate relative to the ray, and e the largest extent of a triangle. The
/// corners of a triangle that is hit lie within 2 e of the ray, and each is known to within 2 d after the shear. An
/// edge function, a difference of two products, is then off by at most 16 d e + 8 d^2 plus the rounding of the
/// products, 16 e^2 2^-24.
template <int Axis>
class TriangleFilter
{
public:
  /// The triangles `first` and on; reads four whatever their number. Called, it costs packets 6 %.
  [[gnu::always_inline]] TriangleFilter(const bricks::TriangleBrick& brick, std::uint32_t first)
  {
    const bricks::TriangleBrickVertex* vertices = brick.GetVertices();
    const std::uint16_t* corners = brick.GetTriangle(first);
    for (int corner = 0; corner < 3; ++corner)
    {
      bricks::Float4* const position = this->Corners[corner];
      bricks::Float4::LoadTransposed(vertices[corners[corner]].Position,
        vertices[corners[corner + 3]].Position, vertices[corners[corner + 6]].Position,
        vertices[corners[corner + 9]].Position, position[0], position[1], position[2]);
    }
  }

  /// Bit i is set where triangle first + i may be hit.
  unsigned FindCandidates(const FilterRay& ray) const
  {
    const bricks::Float4 origin[3] = { bricks::Float4::Fill(ray.Origin[0]),
      bricks::Float4::Fill(ray.Origin[1]), bricks::Float4::Fill(ray.Origin[2]) };
    const bricks::Float4 shearX = bricks::Float4::Fill(ray.Shear[0]);
    const bricks::Float4 shearY = bricks::Float4::Fill(ray.Shear[1]);
    // Each corner sheared so that the ray is the origin of the plane.
    bricks::Float4 x[3];
    bricks::Float4 y[3];
    for (int corner = 0; corner < 3; ++corner)
    {
      const bricks::Float4* const position = this->Corners[corner];
      const bricks::Float4 z = position[Axis] - origin[Axis];
      x[corner] = position[(Axis + 1) % 3] - origin[(Axis + 1) % 3] - shearX * z;
      y[corner] = position[(Axis + 2) % 3] - origin[(Axis + 2) % 3] - shearY * z;
    }
    const bricks::Float4 u = x[2] * y[1] - y[2] * x[1];
    const bricks::Float4 v = x[0] * y[2] - y[0] * x[2];
    const bricks::Float4 w = x[1] * y[0] - y[1] * x[0];
    // Written so that what is not a number is a candidate.
    return ~GetBothLess(Min(Min(u, v), w), bricks::Float4::Fill(-ray.Error),
      bricks::Float4::Fill(ray.Error), Max(Max(u, v), w));
  }

private:
  bricks::Float4 Corners[3][3]; ///< by corner, then axis
};

} // namespace rt

#endif
