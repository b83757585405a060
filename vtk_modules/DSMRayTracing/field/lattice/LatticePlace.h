// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticePlace_h
#define rt_LatticePlace_h

#include "DSMBricks/base/Box.h"
#include "DSMCore/base/Block.h"
#include "DSMRayTracing/field/IsosurfaceHit.h"

#include <glm/vec3.hpp>

namespace rt
{

/// A place in a lattice.
struct LatticePlace
{
  glm::dvec3 IndexPoint{ 0.0 };
  /// IndexPoint may be on a face that the cell shares with another.
  glm::ivec3 Cell{ 0 };
  dsm::BlockId Brick = 0; ///< the one that holds it

  bricks::Index3 GetCell() const { return bricks::Index3(this->Cell); }
};

using LatticeHit = IsosurfaceHit<LatticePlace>;

} // namespace rt

#endif
