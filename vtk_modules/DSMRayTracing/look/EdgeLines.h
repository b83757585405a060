// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_EdgeLines_h
#define rt_EdgeLines_h

#include <glm/vec3.hpp>

namespace rt
{

/// Lines along the edges of a mesh's polygons, as VTK draws them on a surface: they take their share
/// of the triangles beside them, and are not lit.
struct EdgeLines
{
  glm::vec3 Color{ 0.0f };
  /// Pixels, of both triangles beside an edge together.
  float Width = 1.0f;
  float Opacity = 1.0f; ///< over the surface
};

} // namespace rt

#endif
