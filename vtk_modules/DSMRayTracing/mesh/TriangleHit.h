// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TriangleHit_h
#define rt_TriangleHit_h

#include <cstdint>

namespace rt
{

/// Intersection of a ray with a triangle.
struct TriangleHit
{
  double T = 0.0;
  /// Weights of the corners; not negative, their sum is 1.
  double Weights[3] = { 0.0, 0.0, 0.0 };
  float Corners[3][3] = {}; ///< relative to the mesh's origin
  bool Front =
    false; ///< true if the ray comes from the side where the corners are counter-clockwise
  std::uint32_t Brick = 0;
  std::uint32_t Triangle = 0; ///< index in the brick
};

/// Returns whether `a` comes before `b` among hits at the same T: the one with the
/// lexicographically smaller corners. The rule is geometric, so the order in which triangles are
/// tried makes no difference where a ray meets an edge. Among duplicate triangles of a mesh, the
/// first in the order of the bricks is taken.
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
