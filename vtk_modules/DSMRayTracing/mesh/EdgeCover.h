// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_EdgeCover_h
#define rt_EdgeCover_h

#include <glm/geometric.hpp>
#include <glm/mat4x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rt
{

/// How much of a place in a triangle, in [0, 1], the lines along its sides cover that `edgeFlags` says are edges
/// (AllEdges). A line is `width` pixels of the picture wide, a half of it in the triangle, and falls off within a
/// pixel; VTK's shader does the same. As there, a line extends beyond the ends of its side, as far as the triangle
/// does.
///
/// `worldToPixels`: of a PictureView; corners may lie behind the camera. Pure.
inline double GetEdgeCover(const glm::dvec3& position, const glm::dvec3 corners[3],
  unsigned edgeFlags, float width, const glm::dmat4x3& worldToPixels)
{
  const glm::dvec3 place = worldToPixels * glm::dvec4(position, 1.0);
  // Relative to the place, so that no digits are lost: x and y times the third coordinate.
  glm::dvec3 points[3];
  for (int corner = 0; corner < 3; ++corner)
  {
    points[corner] = worldToPixels * glm::dvec4(corners[corner], 1.0);
    points[corner].x -= place.x / place.z * points[corner].z;
    points[corner].y -= place.y / place.z * points[corner].z;
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (int side = 0; side < 3; ++side)
  {
    if ((edgeFlags >> side & 1u) != 0)
    {
      // The line through two homogeneous points is their cross product.
      const glm::dvec3 line = glm::cross(points[side], points[(side + 1) % 3]);
      const double length = std::hypot(line.x, line.y);
      if (length > 0.0)
      {
        nearest = std::min(nearest, std::abs(line.z) / length);
      }
    }
  }
  return std::clamp(0.5 + 0.5 * width - nearest, 0.0, 1.0);
}

} // namespace rt

#endif
