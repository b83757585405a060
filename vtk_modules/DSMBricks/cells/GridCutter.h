// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_GridCutter_h
#define bricks_GridCutter_h

#include "DSMBricks/cells/CellSource.h"
#include "DSMBricks/layout/BrickSpace.h"
#include "DSMBricks/sorted/RecordReader.h"

#include <cstdint>
#include <vector>

namespace bricks
{

/// A brick of a structured grid, with the numbers of its points in the source.
struct GridBrick
{
  RecordBrick Brick;
  std::vector<std::uint32_t> Points;
};

/// Cuts this rank's structured grids into bricks of up to 16 cells on each axis; those without shown cells are left
/// out. Cells with a corner that is not finite are not shown. `threads`: the calling one included.
std::vector<GridBrick> CutGrids(const CellSource& source, const BrickSpace& space, int threads);

} // namespace bricks

#endif
