// SPDX-License-Identifier: BSD-3-Clause
#ifndef TestCells_h
#define TestCells_h

#include "DSMBricks/cells/CellSource.h"
#include "DSMBricks/cells/SharedPlaces.h"
#include "DSMBricks/layout/BrickSpace.h"
#include "DSMBricks/layout/PlaceInBrick.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace TestCells
{

using Position = std::array<double, 3>;

/// Cells with values at their points and of their own, in memory.
class Cells final : public bricks::CellSource
{
public:
  std::vector<Position> Positions;
  std::vector<double> PointValues;
  std::vector<std::array<std::uint64_t, 8>> Corners;
  std::vector<double> CellValues;
  std::vector<bool> Hidden; ///< of cells; may be empty
  std::vector<Grid> Grids;
  std::uint64_t GridCells = 0; ///< the first cells, which are in the grids
  bool AreTetrahedra = false;  ///< only the first four corners count

  std::uint64_t GetCellCount() const override { return this->Corners.size(); }
  std::uint64_t GetPointCount() const override { return this->Positions.size(); }
  std::vector<Grid> GetGrids() const override { return this->Grids; }
  bool HasOnlyTetrahedra() const override { return this->AreTetrahedra; }
  void GetCorners(std::uint64_t cell, std::uint64_t points[MostCorners]) const override
  {
    const bool isInGrid = cell < this->GridCells;
    std::copy_n(this->Corners[cell].begin(), this->AreTetrahedra && !isInGrid ? 4 : 8, points);
  }
  bool IsShown(std::uint64_t cell) const override
  {
    return this->Hidden.empty() || !this->Hidden[cell];
  }
  void GetPosition(std::uint64_t point, double position[3]) const override
  {
    std::copy_n(this->Positions[point].begin(), 3, position);
  }

  template <class Function>
  void SetPointValues(const Function& function)
  {
    this->PointValues.clear();
    for (const Position& position : this->Positions)
    {
      this->PointValues.push_back(function(position));
    }
  }
};

/// Moves a point of a lattice by up to a quarter of a cell; the same way each time.
inline Position MovePoint(int x, int y, int z)
{
  std::mt19937 random(static_cast<unsigned>(x + 100 * (y + 100 * z)));
  std::uniform_real_distribution<double> way(-0.25, 0.25);
  Position position{ double(x), double(y), double(z) };
  for (double& coordinate : position)
  {
    coordinate += way(random);
  }
  return position;
}

/// n^3 hexahedra of a lattice, whose points are moved if `isMoved`.
inline Cells CreateHexahedra(int n, bool isMoved)
{
  Cells cells;
  for (int z = 0; z <= n; ++z)
  {
    for (int y = 0; y <= n; ++y)
    {
      for (int x = 0; x <= n; ++x)
      {
        cells.Positions.push_back(
          isMoved ? MovePoint(x, y, z) : Position{ double(x), double(y), double(z) });
      }
    }
  }
  const auto row = static_cast<std::uint64_t>(n) + 1;
  const std::uint64_t layer = row * row;
  for (int z = 0; z < n; ++z)
  {
    for (int y = 0; y < n; ++y)
    {
      for (int x = 0; x < n; ++x)
      {
        const std::uint64_t first = static_cast<std::uint64_t>(x) +
          row * static_cast<std::uint64_t>(y) + layer * static_cast<std::uint64_t>(z);
        cells.Corners.push_back({ first, first + 1, first + 1 + row, first + row, first + layer,
          first + 1 + layer, first + 1 + row + layer, first + row + layer });
      }
    }
  }
  return cells;
}

/// The hexahedra cut into tetrahedra (`pattern` 0), wedges (1), or pyramids around their centers (2), as hexahedra with
/// repeated corners.
inline Cells Cut(const Cells& hexahedra, int pattern)
{
  Cells cut = hexahedra;
  cut.Corners.clear();
  for (const auto& c : hexahedra.Corners)
  {
    if (pattern == 0)
    {
      static constexpr int tetrahedra[6][4] = { { 0, 1, 2, 6 }, { 0, 2, 3, 6 }, { 0, 3, 7, 6 },
        { 0, 7, 4, 6 }, { 0, 4, 5, 6 }, { 0, 5, 1, 6 } };
      for (const auto& t : tetrahedra)
      {
        cut.Corners.push_back(
          { c[t[0]], c[t[1]], c[t[2]], c[t[2]], c[t[3]], c[t[3]], c[t[3]], c[t[3]] });
      }
    }
    else if (pattern == 1)
    {
      cut.Corners.push_back({ c[0], c[1], c[2], c[2], c[4], c[5], c[6], c[6] });
      cut.Corners.push_back({ c[0], c[2], c[3], c[3], c[4], c[6], c[7], c[7] });
    }
    else
    {
      Position center{};
      for (const std::uint64_t corner : c)
      {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          center[axis] += cut.Positions[corner][axis] / 8.0;
        }
      }
      const std::uint64_t top = cut.Positions.size();
      cut.Positions.push_back(center);
      static constexpr int faces[6][4] = { { 0, 1, 2, 3 }, { 4, 5, 6, 7 }, { 0, 1, 5, 4 },
        { 3, 2, 6, 7 }, { 0, 3, 7, 4 }, { 1, 2, 6, 5 } };
      for (const auto& f : faces)
      {
        cut.Corners.push_back({ c[f[0]], c[f[1]], c[f[2]], c[f[3]], top, top, top, top });
      }
    }
  }
  return cut;
}

/// A part of a dataset with the number of each of its points in the whole.
struct Piece
{
  Cells Own;
  std::vector<std::uint64_t> Points;
};

/// This rank's cells of a random distribution, in random order, with points of their own. `copies`: so many copies of
/// each point, which cells choose from at random.
inline Piece TakePiece(const Cells& all, int rank, int ranks, unsigned seed, int copies = 1)
{
  std::mt19937 random(seed);
  std::vector<std::size_t> mine;
  for (std::size_t cell = 0; cell < all.Corners.size(); ++cell)
  {
    if (static_cast<int>(random() % static_cast<unsigned>(ranks)) == rank)
    {
      mine.push_back(cell);
    }
  }
  std::shuffle(mine.begin(), mine.end(), random);
  Piece piece;
  piece.Own.AreTetrahedra = all.AreTetrahedra;
  std::map<std::pair<std::uint64_t, unsigned>, std::uint64_t> numbers;
  for (const std::size_t cell : mine)
  {
    std::array<std::uint64_t, 8> corners{};
    const std::size_t count = all.AreTetrahedra ? 4 : 8;
    for (std::size_t corner = 0; corner < count; ++corner)
    {
      const std::uint64_t point = all.Corners[cell][corner];
      const unsigned copy = random() % static_cast<unsigned>(copies);
      const auto [place, isNew] =
        numbers.emplace(std::make_pair(point, copy), piece.Own.Positions.size());
      if (isNew)
      {
        piece.Points.push_back(point);
        piece.Own.Positions.push_back(all.Positions[point]);
        if (!all.PointValues.empty())
        {
          piece.Own.PointValues.push_back(all.PointValues[point]);
        }
      }
      corners[corner] = place->second;
    }
    piece.Own.Corners.push_back(corners);
    if (!all.CellValues.empty())
    {
      piece.Own.CellValues.push_back(all.CellValues[cell]);
    }
    if (!all.Hidden.empty())
    {
      piece.Own.Hidden.push_back(all.Hidden[cell]);
    }
  }
  return piece;
}

inline bricks::SharedPlaces FindPlaces(const bricks::CellSource& cells,
  const bricks::BrickSpace& space, int threads, dsm::Messenger& messenger)
{
  const auto getPlace = [&](std::uint64_t point, float place[3])
  {
    double position[3];
    cells.GetPosition(point, position);
    return bricks::PlaceInBrick(space, position, place);
  };
  return bricks::SharedPlaces("test", cells.GetPointCount(), getPlace, threads, messenger);
}

} // namespace TestCells

#endif
