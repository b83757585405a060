// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CellBricks_h
#define bricks_CellBricks_h

#include "DSMBricks/accel/BoundingBox.h"
#include "DSMBricks/accel/BrickHierarchy.h"
#include "DSMBricks/base/ValueRange.h"
#include "DSMBricks/layout/BrickSpace.h"
#include "DSMBricks/layout/IsovalueSurvey.h"
#include "DSMCore/publish/BlockSegment.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace bricks
{

/// Cells in bricks (CellBrick), without values: what all arrays of a dataset share. The same on every rank.
struct CellBricks : BrickSpace
{
  std::uint64_t Cells = 0;   ///< that are in bricks, over all ranks
  double ShortestEdge = 0.0; ///< mean of the bricks' shortest edges, in the space of the bricks
  double MeanEdge = 0.0;     ///< edge of a cube as large as a cell of mean size, likewise
  std::shared_ptr<dsm::BlockSegment> Segment;
  std::vector<BoundingBox> Boxes; ///< of the bricks, by their numbers

  std::size_t GetBytes() const { return this->Boxes.size() * sizeof(BoundingBox); }
};

/// Values at the corners of cells. The same on every rank.
struct CellValues
{
  std::shared_ptr<const CellBricks> Cells;
  /// Block i has the values of brick i (CellValueBrick).
  std::shared_ptr<dsm::BlockSegment> Segment;
  RangedBrickBvh Hierarchy;
  IsovalueSurvey Survey;
};

} // namespace bricks

#endif
