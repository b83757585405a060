// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SplitCells_h
#define rt_SplitCells_h

#include "DSMBricks/cells/CellBrick.h"
#include "DSMBricks/cells/SplitCell.h"

#include <cmath>
#include <cstdint>

namespace rt
{

/// Splits a cell into tetrahedra, as all bricks do that have points in common: by x, then y, then z of the points.
/// `cell`: the numbers of the cell's corners. Writes corners of the cell. Returns how many tetrahedra there are.
inline int SplitCell(const bricks::CellBrick& brick, const std::uint16_t* cell,
  std::uint8_t tetrahedra[bricks::MostTetrahedra][4])
{
  if (brick.GetHeader().Corners == 4)
  {
    for (int corner = 0; corner < 4; ++corner)
    {
      tetrahedra[0][corner] = static_cast<std::uint8_t>(corner);
    }
    return 1;
  }
  if (brick.IsOfGrid())
  {
    const auto isBefore = [&](int one, int other)
    {
      const float* const a = brick.GetPoint(cell[one]);
      const float* const b = brick.GetPoint(cell[other]);
      return a[0] != b[0] ? a[0] < b[0] : a[1] != b[1] ? a[1] < b[1] : a[2] < b[2];
    };
    bricks::SplitHexahedronBy(isBefore, tetrahedra);
  }
  else
  {
    bricks::SplitHexahedronBy(
      [&](int one, int other) { return cell[one] < cell[other]; }, tetrahedra);
  }
  return bricks::MostTetrahedra;
}

/// Returns whether all corners of a cell have values.
inline bool HasValues(const float* values, const std::uint16_t* cell, int corners)
{
  for (int corner = 0; corner < corners; ++corner)
  {
    if (std::isnan(values[cell[corner]]))
    {
      return false;
    }
  }
  return true;
}

} // namespace rt

#endif
