// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TriangleHit_h
#define rt_TriangleHit_h

#include <cstdint>

namespace rt
{

/// Where a ray meets a triangle.
struct TriangleHit
{
  double T = 0.0;
  /// Weights of the corners; not negative, their sum is 1.
  double Weights[3] = { 0.0, 0.0, 0.0 };
  float Corners[3][3] = {}; ///< relative to the mesh's origin
  bool Front = false;       ///< whether the ray comes from where the corners are counter-clockwise
  std::uint32_t Brick = 0;
  std::uint32_t Triangle = 0; ///< of the brick
};

/// Whether `a` comes before `b` among hits at the same T: the lexicographically smaller corners. A
/// rule of geometry, so that where a ray meets an edge, the order in which triangles are tried makes
/// no difference; of triangles that are in the mesh twice, the first in the order of the bricks.
inline bool ComesFirst(const TriangleHit& a, const TriangleHit& b)
{
  for (int corner = 0; corner < 3; ++corner)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (a.Corners[corner][axis] != b.Corners[corner][axis])
      {
        return a.Corners[corner][axis] < b.Corners[corner][axis];
      }
    }
  }
  return a.Brick != b.Brick ? a.Brick < b.Brick : a.Triangle < b.Triangle;
}

} // namespace rt

#endif
