// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfaceHit_h
#define rt_IsosurfaceHit_h

#include "DSMCore/base/Block.h"

#include <glm/vec3.hpp>

namespace rt
{

/// Where a ray meets an isosurface first.
struct IsosurfaceHit
{
  double T = 0.0;
  /// Unit, world space; the direction in which the scalar falls (away from the larger values), as
  /// Contour's normals point.
  glm::dvec3 Normal{ 0.0 };
  int Isovalue = 0;        ///< index into IsosurfaceObject::Isovalues
  dsm::BlockId Brick = 0;  ///< the brick that holds the hit
  bool FromInside = false; ///< the ray comes from values that are not below the isovalue
  glm::dvec3 IndexPoint{ 0.0 };
  /// Of the lattice. IndexPoint may be on a face that it shares with another.
  glm::ivec3 Cell{ 0 };
};

} // namespace rt

#endif
