// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Texture_h
#define rt_Texture_h

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace rt
{

/// A picture that is laid on a surface; whole on every rank. Read as OpenGL reads one.
struct Texture
{
  int Width = 0;
  int Height = 0;
  /// Four bytes a texel, red first, from the lower left one, row by row; alpha is opacity.
  std::vector<std::uint8_t> Texels;
  /// False: the border of the image is repeated beyond it.
  bool Repeat = true;
  /// Off: the nearest texel.
  bool Interpolate = false;
  /// From a surface's texture coordinates to the picture's, [0, 1] on each axis.
  glm::dmat4 Transform{ 1.0 };

  /// In [0, 1]; white without a picture.
  glm::vec4 Sample(const glm::dvec2& coordinate) const;

private:
  glm::vec4 GetTexel(double x, double y) const;
};

} // namespace rt

#endif
