// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_ShownCells_h
#define bricks_ShownCells_h

#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/base/SharedProgress.h"
#include "DSMBricks/cells/CellSource.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bricks
{

/// Calls visit(cell, points, isShown) for cells [first, last), all in one grid or all in none, in order. `points`: of a
/// cell that is shown.
template <class Visit>
void ForEachCellRead(
  const CellSource& source, std::uint64_t first, std::uint64_t last, const Visit& visit)
{
  constexpr std::uint64_t cellsTogether = 64;
  std::uint64_t points[cellsTogether][CellSource::MostCorners];
  bool areShown[cellsTogether];
  for (std::uint64_t begin = first; begin < last; begin += cellsTogether)
  {
    const std::uint64_t count = std::min(cellsTogether, last - begin);
    source.ReadCells(begin, static_cast<std::size_t>(count), points, areShown);
    for (std::uint64_t number = 0; number < count; ++number)
    {
      visit(begin + number, static_cast<const std::uint64_t*>(points[number]), areShown[number]);
    }
  }
}

/// Calls visit(cell, points, corners, chunk, thread) for every shown cell of this rank, in any order, by several
/// threads at a time. `points`: the cell's corners, so many: 4 or 8. Cells of the same chunk are visited by one thread;
/// they are the same each time. `progress`: each cell is a step. Rethrows what a call throws.
template <class Visit>
void ForEachShownCell(
  const CellSource& source, int threads, SharedProgress& progress, const Visit& visit)
{
  constexpr std::uint64_t cellsOfStep = 4096;
  // Large chunks have few corners in common.
  constexpr std::uint64_t fewestCells = 8192;
  const auto chunks = 8 * static_cast<std::uint64_t>(std::max(threads, 1));
  const std::uint64_t cellsOfChunk = std::max(source.GetCellCount() / chunks + 1, fewestCells);
  std::size_t chunksBefore = 0;
  const auto visitRange = [&](std::uint64_t first, std::uint64_t last, int corners)
  {
    ParallelForChunks(threads, last - first, cellsOfChunk,
      [&](std::size_t begin, std::size_t end, std::size_t chunk, int thread)
      {
        for (std::uint64_t step = first + begin; step < first + end; step += cellsOfStep)
        {
          const std::uint64_t endOfStep = std::min(step + cellsOfStep, first + end);
          ForEachCellRead(source, step, endOfStep,
            [&](std::uint64_t cell, const std::uint64_t* points, bool isShown)
            {
              if (isShown)
              {
                visit(cell, points, corners, chunksBefore + chunk, thread);
              }
            });
          progress.Add(thread, static_cast<std::size_t>(endOfStep - step));
        }
      });
    chunksBefore += (last - first + cellsOfChunk - 1) / cellsOfChunk;
  };
  const int corners = source.HasOnlyTetrahedra() ? 4 : CellSource::MostCorners;
  std::uint64_t next = 0;
  for (const CellSource::Grid& grid : source.GetGrids())
  {
    const Index3 cells = grid.Points - Index3(1);
    const std::uint64_t end =
      grid.FirstCell + static_cast<std::uint64_t>(cells.x * cells.y * cells.z);
    visitRange(next, grid.FirstCell, corners);
    visitRange(grid.FirstCell, end, CellSource::MostCorners);
    next = end;
  }
  visitRange(next, source.GetCellCount(), corners);
}

} // namespace bricks

#endif
