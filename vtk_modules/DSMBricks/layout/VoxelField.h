// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_VoxelField_h
#define bricks_VoxelField_h

#include "DSMBricks/layout/BrickLattice.h"
#include "DSMBricks/layout/GridPlanes.h"
#include "DSMBricks/layout/IsovalueSurvey.h"
#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMCore/publish/BlockSegment.h"

#include <memory>
#include <optional>

namespace bricks
{

/// One array of a volume, in bricks. Shared by all that draw it.
struct VoxelField
{
  BrickLattice Lattice;
  std::shared_ptr<dsm::BlockSegment> Segment;
  MacrocellHierarchy Hierarchy;
  /// Cells that another field shows instead of this one; the ranges of the bricks there are empty.
  Box Hole;
  /// Where the planes between cells are; null: at equal distances.
  std::shared_ptr<const GridPlanes> Planes;
  /// Survey of all bricks, the same on every rank; empty if the bricks have to be examined for it.
  std::optional<IsovalueSurvey> Survey;
};

} // namespace bricks

#endif
