// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_SplitCells_h
#define rt_SplitCells_h

#include "DSMBricks/cells/CellBrick.h"
#include "DSMBricks/cells/SplitCell.h"

#include <cmath>
#include <cstdint>
#include <utility>

namespace rt
{

/// Numbers of the corners of a hexahedron of a structured grid in the order of points of other bricks: by x, then y,
/// then z. Corners at the same place have the same number.
inline void OrderCorners(
  const bricks::CellBrick& brick, const std::uint16_t corners[8], std::uint16_t places[8])
{
  const float* points[8];
  for (int corner = 0; corner < 8; ++corner)
  {
    points[corner] = brick.GetPoint(corners[corner]);
    places[corner] = 0;
  }
  const auto isBefore = [](const float* one, const float* other)
  {
    return one[0] != other[0] ? one[0] < other[0]
      : one[1] != other[1]    ? one[1] < other[1]
                              : one[2] < other[2];
  };
  for (int corner = 0; corner < 8; ++corner)
  {
    for (int other = 0; other < corner; ++other)
    {
      places[corner] += isBefore(points[other], points[corner]) ? 1 : 0;
      places[other] += isBefore(points[corner], points[other]) ? 1 : 0;
    }
  }
}

/// Calls `visit(corners)` with the numbers of the four points of each tetrahedron of a cell, in the order in which all
/// bricks have them. `cell`: the numbers of the cell's corners.
template <class Visit>
inline void SplitCell(const bricks::CellBrick& brick, const std::uint16_t* cell, const Visit& visit)
{
  if (brick.GetHeader().Corners == 4)
  {
    std::uint8_t order[4] = { 0, 1, 2, 3 };
    if (bricks::SortCorners(cell, order))
    {
      const std::uint16_t corners[4] = { cell[order[0]], cell[order[1]], cell[order[2]],
        cell[order[3]] };
      visit(corners);
    }
    return;
  }
  std::uint16_t places[8];
  const std::uint16_t* ordered = cell;
  if (brick.IsOfGrid())
  {
    OrderCorners(brick, cell, places);
    ordered = places;
  }
  std::uint8_t tetrahedra[bricks::MostTetrahedra][4];
  const int count = bricks::SplitHexahedron(ordered, tetrahedra);
  for (int number = 0; number < count; ++number)
  {
    const std::uint8_t* const order = tetrahedra[number];
    const std::uint16_t corners[4] = { cell[order[0]], cell[order[1]], cell[order[2]],
      cell[order[3]] };
    visit(corners);
  }
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
