// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_BrickSpace_h
#define bricks_BrickSpace_h

#include <glm/vec3.hpp>

namespace bricks
{

/// The space of bricks whose primitives have positions of their own, such as triangles.
struct BrickSpace
{
  /// Positions in bricks are floats, in units of Scale, relative to this point of the dataset's space. It is 0 on an
  /// axis unless the dataset is small compared to its distance from 0; then it is near the dataset's middle and
  /// a multiple of a power of two no smaller than the dataset. Either way coordinates that came as
  /// floats are kept exactly, and doubles to 2^-22 of the dataset's size or better, wherever in the
  /// world it is.
  glm::dvec3 Origin{ 0.0 };
  /// 1 unless coordinates are so large that products of them leave the range of floats; then a power of two.
  double Scale = 1.0;
  /// In units of Scale, relative to Origin; Lower > Upper for a dataset without primitives.
  glm::dvec3 Lower{ 1.0 };
  glm::dvec3 Upper{ -1.0 };
};

} // namespace bricks

#endif
