// SPDX-License-Identifier: BSD-3-Clause
// Bricks give back the cells that were written, to the last bit.
#include "DSMBricks/cells/CellBrick.h"
#include "DSMBricks/cells/CellBrickWriter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace
{

using Place = std::array<float, 3>;
using PlacedCell = std::vector<Place>;

/// The cells of a brick by the places of their corners, sorted.
std::vector<PlacedCell> ReadCells(const bricks::RecordBrick& written)
{
  const bricks::CellBrick brick(written.Bytes.data());
  std::vector<PlacedCell> cells;
  bricks::CellGroup group;
  for (std::uint32_t number = 0; number < brick.GetHeader().Groups; ++number)
  {
    brick.ReadGroup(number, group);
    for (int cell = 0; cell < group.Cells; ++cell)
    {
      PlacedCell& read = cells.emplace_back();
      for (int corner = 0; corner < group.Corners; ++corner)
      {
        Place place;
        brick.GetPoint(group.Numbers[group.At[cell][corner]], place.data());
        read.push_back(place);
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// Random points; `kind`: 0 all the same, 1 in a unit cube, 2 of all sizes and both signs.
std::vector<float> CreatePoints(std::size_t count, int kind, std::mt19937& random)
{
  std::vector<float> points(3 * count, 0.25f);
  for (float& coordinate : points)
  {
    const float number = std::uniform_real_distribution<float>(0.0f, 1.0f)(random);
    const int exponent = static_cast<int>(random() % 200) - 100;
    coordinate = kind == 0 ? coordinate : kind == 1 ? number : std::ldexp(number - 0.5f, exponent);
  }
  return points;
}

TEST(CellBrickTest, GivesBackCells)
{
  std::mt19937 random(3);
  for (const int corners : { 4, 8 })
  {
    for (const std::size_t count : { 1, 7, 8, 9, 65, 1000, 5000 })
    {
      for (int kind = 0; kind < 3; ++kind)
      {
        const std::size_t pointCount = corners + count;
        const std::vector<float> points = CreatePoints(pointCount, kind, random);
        std::vector<std::uint16_t> numbers;
        std::vector<PlacedCell> expected(count);
        for (PlacedCell& cell : expected)
        {
          for (int corner = 0; corner < corners; ++corner)
          {
            const std::size_t point = random() % pointCount;
            numbers.push_back(static_cast<std::uint16_t>(point));
            cell.push_back({ points[3 * point], points[3 * point + 1], points[3 * point + 2] });
          }
        }
        std::sort(expected.begin(), expected.end());
        bricks::CellBrickWriter writer;
        const bricks::RecordBrick brick = writer.Write(points, numbers, corners);
        EXPECT_EQ(ReadCells(brick), expected) << corners << " corners, " << count << " cells";
        EXPECT_EQ(bricks::CellBrick(brick.Bytes.data()).GetHeader().Cells, count);
      }
    }
  }
}

TEST(CellBrickTest, GivesBackShownCellsOfGrids)
{
  std::mt19937 random(4);
  const std::uint16_t cells[3] = { 5, 4, 3 };
  const std::vector<float> points = CreatePoints(6 * 5 * 4, 1, random);
  std::vector<std::uint8_t> shown;
  std::vector<PlacedCell> expected;
  for (std::size_t z = 0; z < cells[2]; ++z)
  {
    for (std::size_t y = 0; y < cells[1]; ++y)
    {
      for (std::size_t x = 0; x < cells[0]; ++x)
      {
        shown.push_back(static_cast<std::uint8_t>(random() % 3 != 0));
        if (shown.back() == 0)
        {
          continue;
        }
        PlacedCell& cell = expected.emplace_back();
        const std::size_t offsets[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
          { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
        for (const auto& offset : offsets)
        {
          const std::size_t point = x + offset[0] + 6 * (y + offset[1] + 5 * (z + offset[2]));
          cell.push_back({ points[3 * point], points[3 * point + 1], points[3 * point + 2] });
        }
      }
    }
  }
  std::sort(expected.begin(), expected.end());
  bricks::CellBrickWriter writer;
  EXPECT_EQ(ReadCells(writer.WriteGrid(points, cells, shown)), expected);
}

} // namespace
