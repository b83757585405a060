// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VoxelField_h
#define rt_VoxelField_h

#include "DSMCore/publish/BlockSegment.h"
#include "DSMRayTracing/layout/BrickLattice.h"
#include "DSMRayTracing/layout/MacrocellHierarchy.h"

#include <memory>

namespace rt
{

/// One array of a volume, in bricks. Shared by all that draw it.
struct VoxelField
{
  BrickLattice Lattice;
  std::shared_ptr<dsm::BlockSegment> Segment;
  MacrocellHierarchy Hierarchy;
};

} // namespace rt

#endif
