// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/AverageCells.h"
#include "TestCells.h"
#include "tests/support/LoopbackCluster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <mutex>

namespace
{

using namespace TestCells;

constexpr float NoMean = std::numeric_limits<float>::quiet_NaN();

/// The means of all points, found on so many ranks; those that no rank has are missing.
std::vector<float> FindMeans(
  const Cells& all, int ranks, unsigned seed, int copies = 1, int threads = 2)
{
  std::mutex guard;
  std::vector<float> found(all.Positions.size(), NoMean);
  RunOnCluster(ranks,
    [&](dsm::Messenger& messenger)
    {
      const Piece piece = TakePiece(all, messenger.GetRank(), ranks, seed, copies);
      const bricks::SharedPlaces places = FindPlaces(piece.Own, {}, threads, messenger);
      const auto means = bricks::AverageCells(
        "test", piece.Own, places, [&](std::uint64_t cell) { return piece.Own.CellValues[cell]; },
        threads, messenger);
      const std::lock_guard<std::mutex> lock(guard);
      ASSERT_EQ(means.size(), piece.Points.size());
      for (std::size_t point = 0; point < means.size(); ++point)
      {
        float& mean = found[piece.Points[point]];
        EXPECT_TRUE(std::isnan(mean) || mean == means[point]);
        mean = means[point];
      }
    });
  return found;
}

void ExpectMeans(const std::vector<float>& found, const std::vector<float>& expected)
{
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t point = 0; point < found.size(); ++point)
  {
    EXPECT_TRUE(
      found[point] == expected[point] || (std::isnan(found[point]) && std::isnan(expected[point])))
      << "point " << point << ": " << found[point] << " instead of " << expected[point];
  }
}

} // namespace

TEST(AverageCells, MeansOfALattice)
{
  Cells cells = CreateHexahedra(2, false);
  for (int cell = 0; cell < 8; ++cell)
  {
    cells.CellValues.push_back(cell);
  }
  const auto means = FindMeans(cells, 1, 1);
  EXPECT_EQ(means[0], 0.0f);
  EXPECT_EQ(means[1], 0.5f);
  EXPECT_EQ(means[4], 1.5f);
  EXPECT_EQ(means[13], 3.5f);
  EXPECT_EQ(means[26], 7.0f);
}

TEST(AverageCells, DoNotDependOnTheDistribution)
{
  Cells cells = Cut(CreateHexahedra(5, true), 1);
  std::mt19937 random(9);
  for (std::size_t cell = 0; cell < cells.Corners.size(); ++cell)
  {
    cells.CellValues.push_back(std::exp2(static_cast<double>(random() % 60)) - 1e5);
    cells.Hidden.push_back(random() % 9 == 0);
  }
  cells.CellValues[7] = std::numeric_limits<double>::quiet_NaN();
  cells.CellValues[9] = std::numeric_limits<double>::infinity();
  std::vector<float> expected;
  for (std::size_t point = 0; point < cells.Positions.size(); ++point)
  {
    double sum = 0.0;
    int count = 0;
    for (std::size_t cell = 0; cell < cells.Corners.size(); ++cell)
    {
      const auto& corners = cells.Corners[cell];
      if (!cells.Hidden[cell] && std::isfinite(cells.CellValues[cell]) &&
        std::find(corners.begin(), corners.end(), point) != corners.end())
      {
        sum += cells.CellValues[cell];
        ++count;
      }
    }
    expected.push_back(count > 0 ? static_cast<float>(sum / count) : NoMean);
  }
  for (const int ranks : { 1, 2, 3 })
  {
    for (const int copies : { 1, 3 })
    {
      ExpectMeans(FindMeans(cells, ranks, 5, copies), expected);
    }
  }
}

/// More than one chunk of cells.
TEST(AverageCells, DoNotDependOnTheThreads)
{
  Cells cells = CreateHexahedra(32, true);
  std::mt19937 random(4);
  for (std::size_t cell = 0; cell < cells.Corners.size(); ++cell)
  {
    cells.CellValues.push_back(std::exp2(static_cast<double>(random() % 300)));
  }
  const auto expected = FindMeans(cells, 1, 1, 1, 1);
  ExpectMeans(FindMeans(cells, 1, 2, 2, 4), expected);
  ExpectMeans(FindMeans(cells, 2, 3, 2, 2), expected);
}

TEST(AverageCells, ACellCountsOnceForAPlaceOfSeveralCorners)
{
  Cells cells;
  cells.Positions = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 0, 0, 1 },
    { 5, 5, 5 } };
  // A pyramid whose top are two points, and a tetrahedron that has one of them.
  cells.Corners = { { 0, 1, 2, 3, 4, 5, 4, 5 }, { 4, 1, 2, 2, 3, 3, 3, 3 } };
  cells.CellValues = { 1.0, 2.0 };
  ExpectMeans(FindMeans(cells, 1, 1), { 1.0f, 1.5f, 1.5f, 1.5f, 1.5f, 1.5f, NoMean });
}

TEST(AverageCells, SmallValuesAreAsPreciseAsLargeOnes)
{
  Cells cells = CreateHexahedra(1, false);
  const Cells other = CreateHexahedra(1, false);
  for (Position position : other.Positions)
  {
    position[0] += 10.0;
    cells.Positions.push_back(position);
  }
  cells.Corners.push_back({ 8, 9, 10, 11, 12, 13, 14, 15 });
  cells.CellValues = { 1.2345678e-30, 3.4e38 };
  const auto means = FindMeans(cells, 2, 1);
  EXPECT_EQ(means[0], 1.2345678e-30f);
  EXPECT_EQ(means[8], 3.4e38f);
}

TEST(AverageCells, OfEqualValuesAreTheValue)
{
  Cells cells = CreateHexahedra(4, true);
  cells.CellValues.assign(cells.Corners.size(), 0.1f);
  ExpectMeans(FindMeans(cells, 3, 1), std::vector<float>(cells.Positions.size(), 0.1f));
}
