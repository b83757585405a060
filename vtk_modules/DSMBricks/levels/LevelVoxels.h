// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_LevelVoxels_h
#define bricks_LevelVoxels_h

#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/layout/IsovalueSurvey.h"
#include "DSMBricks/levels/LevelLattice.h"
#include "DSMCore/publish/BlockSegment.h"

#include <memory>

namespace bricks
{

/// One array of a dataset of levels, in bricks: voxel bricks of points, whose mask has the leaves. Shared by all
/// that draw it.
struct LevelVoxels
{
  LevelLattice Lattice;
  std::shared_ptr<dsm::BlockSegment> Segment;
  RangedBrickBvh Hierarchy; ///< boxes are in cells of level 0
  IsovalueSurvey Survey;    ///< of all bricks, without fills (FillValues.h); the same on every rank
};

} // namespace bricks

#endif
