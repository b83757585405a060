// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfaceHit_h
#define rt_IsosurfaceHit_h

#include <glm/vec3.hpp>

namespace rt
{

/// First intersection of a ray with an isosurface of a field. `Place` is the position in the
/// field's own coordinates.
template <class Place>
struct IsosurfaceHit
{
  double T = 0.0;
  /// Unit, world space; the direction in which the values fall (away from the larger ones), as
  /// Contour's normals point.
  glm::dvec3 Normal{ 0.0 };
  int Isovalue = 0;        ///< index into LevelSets::Isovalues
  bool FromInside = false; ///< the ray comes from values that are not below the isovalue
  Place At;
};

} // namespace rt

#endif
