// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VoxelField_h
#define rt_VoxelField_h

#include "DSMCore/publish/BlockSegment.h"
#include "DSMRayTracing/layout/BrickLattice.h"
#include "DSMRayTracing/layout/IsovalueSurvey.h"
#include "DSMRayTracing/layout/MacrocellHierarchy.h"

#include <memory>
#include <optional>

namespace rt
{

/// One array of a volume, in bricks. Shared by all that draw it.
struct VoxelField
{
  BrickLattice Lattice;
  std::shared_ptr<dsm::BlockSegment> Segment;
  MacrocellHierarchy Hierarchy;
  /// Of all bricks, the same on every rank, where they need not be looked through for it.
  std::optional<IsovalueSurvey> Survey;
};

} // namespace rt

#endif
