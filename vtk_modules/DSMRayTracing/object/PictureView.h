// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PictureView_h
#define rt_PictureView_h

#include <glm/geometric.hpp>
#include <glm/mat4x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace rt
{

/// Projection of world points to the picture, for details of constant width on the screen.
struct PictureView
{
  /// Takes a world point (with a fourth coordinate of 1) to the picture: x and y in pixels, both times
  /// the third coordinate.
  glm::dmat4x3 WorldToPixels{ 1.0 };
  /// See FrameRequest::PixelSize.
  float PixelSize = 1.0f;

  /// The view for what is seen in a mirror at `position`, as it would look were the mirror a window to the world
  /// behind it. `normal` is unit.
  PictureView GetMirrored(const glm::dvec3& position, const glm::dvec3& normal) const
  {
    glm::dmat4 mirror(1.0);
    for (int column = 0; column < 3; ++column)
    {
      mirror[column] -= glm::dvec4(2.0 * normal[column] * normal, 0.0);
    }
    mirror[3] += glm::dvec4(2.0 * glm::dot(position, normal) * normal, 0.0);
    return { this->WorldToPixels * mirror, this->PixelSize };
  }
};

} // namespace rt

#endif
