// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CellSource_h
#define bricks_CellSource_h

#include "DSMBricks/base/Box.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bricks
{

/// One rank's cells, as this rank has them: any part of the dataset, in any order, none at all. Implemented over VTK's
/// grids, and by generators. All numbers are of this piece, from 0. While bricks are built, several threads call at
/// the same time.
///
/// A cell is a tetrahedron, or a hexahedron some of whose corners may be the same point: a wedge has corners
/// 0 1 2 2 3 4 5 5 of its own, a pyramid 0 1 2 3 4 4 4 4, a tetrahedron among hexahedra 0 1 2 2 3 3 3 3. A cell may be
/// inside out, flat, or a point.
class CellSource
{
public:
  /// The number of a hexahedron's corners.
  static constexpr int MostCorners = 8;

  virtual ~CellSource() = default;

  virtual std::uint64_t GetCellCount() const = 0;
  virtual std::uint64_t GetPointCount() const = 0;

  /// Cells of a structured grid, and its points: both are numbered x fastest, from these on. Such cells are
  /// hexahedra.
  struct Grid
  {
    std::uint64_t FirstCell;
    std::uint64_t FirstPoint;
    Index3 Points; ///< on each axis; two at least
  };
  /// Grids of different cells, in ascending order. Their bricks have no connectivity.
  virtual std::vector<Grid> GetGrids() const { return {}; }

  /// Returns whether all cells that are in no grid have four corners; else, all have eight.
  virtual bool HasOnlyTetrahedra() const = 0;
  /// The points of a cell, in VTK's order. Throws dsm::Error where the dataset has no such point.
  virtual void GetCorners(std::uint64_t cell, std::uint64_t points[MostCorners]) const = 0;
  /// Returns whether the cell is shown, and counts as a neighbor of others: not so ghost cells and blanked ones.
  virtual bool IsShown(std::uint64_t cell) const = 0;
  /// Cells [first, first + count), all in one grid or all in none: whether each is shown, and the points of those that
  /// are. Throws as GetCorners does.
  virtual void ReadCells(std::uint64_t first, std::size_t count,
    std::uint64_t (*points)[MostCorners], bool* areShown) const
  {
    for (std::size_t number = 0; number < count; ++number)
    {
      areShown[number] = this->IsShown(first + number);
      if (areShown[number])
      {
        this->GetCorners(first + number, points[number]);
      }
    }
  }
  /// The points of several shown cells, in any order.
  virtual void ReadCorners(
    const std::uint64_t* cells, std::size_t count, std::uint64_t (*points)[MostCorners]) const
  {
    for (std::size_t number = 0; number < count; ++number)
    {
      this->GetCorners(cells[number], points[number]);
    }
  }
  /// In the dataset's own space. Cells with a corner that is not finite are left out.
  virtual void GetPosition(std::uint64_t point, double position[3]) const = 0;
};

} // namespace bricks

#endif
