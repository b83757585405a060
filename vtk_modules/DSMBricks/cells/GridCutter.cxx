// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/GridCutter.h"

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ParallelFor.h"
#include "DSMBricks/cells/CellBrickWriter.h"
#include "DSMBricks/layout/PlaceInBrick.h"

#include <algorithm>
#include <cstddef>
#include <memory>

namespace bricks
{

namespace
{

/// Cells of a brick on each axis, at most.
constexpr std::int64_t MostEdge = 16;

struct Part
{
  CellSource::Grid Grid;
  Box Cells; ///< of the grid
};

/// The parts of one axis, as even as possible, of an even number of cells but for the last.
std::vector<std::int64_t> Divide(std::int64_t cells)
{
  const std::int64_t parts = (cells + MostEdge - 1) / MostEdge;
  const std::int64_t edge = std::min(((cells + parts - 1) / parts + 1) / 2 * 2, MostEdge);
  std::vector<std::int64_t> borders;
  for (std::int64_t border = 0; border < cells; border += edge)
  {
    borders.push_back(border);
  }
  borders.push_back(cells);
  return borders;
}

void AddParts(const CellSource::Grid& grid, std::vector<Part>& parts)
{
  const std::vector<std::int64_t> x = Divide(grid.Points.x - 1);
  const std::vector<std::int64_t> y = Divide(grid.Points.y - 1);
  const std::vector<std::int64_t> z = Divide(grid.Points.z - 1);
  for (std::size_t k = 0; k + 1 < z.size(); ++k)
  {
    for (std::size_t j = 0; j + 1 < y.size(); ++j)
    {
      for (std::size_t i = 0; i + 1 < x.size(); ++i)
      {
        parts.push_back({ grid, { { x[i], y[j], z[k] }, { x[i + 1], y[j + 1], z[k + 1] } } });
      }
    }
  }
}

class Cutter
{
public:
  Cutter(const CellSource& source, const BrickSpace& space)
    : Source(source)
    , Space(space)
  {
  }

  GridBrick Cut(const Part& part)
  {
    GridBrick brick;
    this->ReadPoints(part, brick.Points);
    this->FindShown(part);
    const glm::i64vec3 size = part.Cells.GetSize();
    const std::uint16_t cells[3] = { static_cast<std::uint16_t>(size.x),
      static_cast<std::uint16_t>(size.y), static_cast<std::uint16_t>(size.z) };
    brick.Brick = this->Writer.WriteGrid(this->Places, cells, this->Shown);
    return brick;
  }

private:
  void ReadPoints(const Part& part, std::vector<std::uint32_t>& points)
  {
    const Index3& all = part.Grid.Points;
    this->Places.clear();
    this->Finite.clear();
    ForEachIndex({ part.Cells.Min, part.Cells.Max + Index3(1) },
      [&](const Index3& at)
      {
        const std::uint64_t point =
          part.Grid.FirstPoint + static_cast<std::uint64_t>(at.x + all.x * (at.y + all.y * at.z));
        points.push_back(static_cast<std::uint32_t>(point));
        double position[3];
        this->Source.GetPosition(point, position);
        float place[3];
        const bool isFinite = PlaceInBrick(this->Space, position, place);
        this->Finite.push_back(isFinite ? 1 : 0);
        for (const float coordinate : place)
        {
          this->Places.push_back(isFinite ? coordinate : 0.0f);
        }
      });
  }

  /// Leaves Shown empty if all cells are shown.
  void FindShown(const Part& part)
  {
    const Index3 cells = part.Grid.Points - Index3(1);
    const Index3 points = part.Cells.GetSize() + Index3(1);
    this->Shown.clear();
    ForEachIndex(part.Cells,
      [&](const Index3& at)
      {
        bool isShown = this->Source.IsShown(part.Grid.FirstCell +
          static_cast<std::uint64_t>(at.x + cells.x * (at.y + cells.y * at.z)));
        ForEachIndex({ at - part.Cells.Min, at - part.Cells.Min + Index3(2) },
          [&](const Index3& corner)
          {
            isShown = isShown &&
              this->Finite[static_cast<std::size_t>(
                corner.x + points.x * (corner.y + points.y * corner.z))] != 0;
          });
        this->Shown.push_back(isShown ? 1 : 0);
      });
    if (std::all_of(
          this->Shown.begin(), this->Shown.end(), [](std::uint8_t is) { return is != 0; }))
    {
      this->Shown.clear();
    }
  }

  const CellSource& Source;
  const BrickSpace& Space;
  std::vector<float> Places;
  std::vector<std::uint8_t> Finite;
  std::vector<std::uint8_t> Shown;
  CellBrickWriter Writer;
};

} // namespace

std::vector<GridBrick> CutGrids(const CellSource& source, const BrickSpace& space, int threads)
{
  std::vector<Part> parts;
  for (const CellSource::Grid& grid : source.GetGrids())
  {
    AddParts(grid, parts);
  }
  std::vector<std::unique_ptr<Cutter>> cutters;
  for (int thread = 0; thread < std::max(threads, 1); ++thread)
  {
    cutters.push_back(std::make_unique<Cutter>(source, space));
  }
  std::vector<GridBrick> bricks(parts.size());
  ParallelFor(static_cast<int>(cutters.size()), parts.size(),
    [&](std::size_t part, int thread)
    { bricks[part] = cutters[static_cast<std::size_t>(thread)]->Cut(parts[part]); });
  bricks.erase(std::remove_if(bricks.begin(), bricks.end(),
                 [](const GridBrick& brick) { return brick.Brick.Bytes.empty(); }),
    bricks.end());
  return bricks;
}

} // namespace bricks
