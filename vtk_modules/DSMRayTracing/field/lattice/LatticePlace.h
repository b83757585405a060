// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticePlace_h
#define rt_LatticePlace_h

#include "DSMBricks/base/Box.h"
#include "DSMCore/base/Block.h"
#include "DSMRayTracing/field/IsosurfaceHit.h"

#include <glm/vec3.hpp>

namespace rt
{

/// A place in a lattice. Without values at first: batches of them are made for each batch of rays.
struct LatticePlace
{
  glm::dvec3 IndexPoint;
  /// IndexPoint may be on a face that the cell shares with another.
  glm::ivec3 Cell;
  dsm::BlockId Brick; ///< the one that holds it

  bricks::Index3 GetCell() const { return bricks::Index3(this->Cell); }
};

using LatticeHit = IsosurfaceHit<LatticePlace>;

} // namespace rt

#endif
