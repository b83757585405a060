// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/cells/PointGradients.h"
#include "DSMCore/base/Error.h"
#include "TestCells.h"
#include "tests/support/LoopbackCluster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <string>

namespace
{

using namespace TestCells;

constexpr double NoValue = std::numeric_limits<double>::quiet_NaN();
const Position Slope{ 3.0, -0.5, 1.25 };

double GetLinear(const Position& position)
{
  return Slope[0] * position[0] + Slope[1] * position[1] + Slope[2] * position[2] - 7.0;
}

std::vector<bricks::PackedGradient> FindGradients(
  const Cells& cells, dsm::Messenger& messenger, int threads, const bricks::BrickSpace& space = {})
{
  const bricks::SharedPlaces places = FindPlaces(cells, space, threads, messenger);
  return bricks::FindPointGradients(
    "test", cells, space, places, [&](std::uint64_t point) { return cells.PointValues[point]; },
    threads, messenger);
}

std::vector<bricks::PackedGradient> FindOnOneRank(
  const Cells& cells, const bricks::BrickSpace& space = {})
{
  std::vector<bricks::PackedGradient> gradients;
  RunOnCluster(
    1, [&](dsm::Messenger& messenger) { gradients = FindGradients(cells, messenger, 2, space); });
  return gradients;
}

std::uint32_t GetBits(const bricks::PackedGradient& gradient)
{
  std::uint32_t bits;
  std::memcpy(&bits, &gradient, sizeof(bits));
  return bits;
}

/// As far as packed gradients are.
void ExpectNear(const bricks::PackedGradient& packed, const Position& expected)
{
  double found[3];
  packed.Unpack(found);
  double both = 0.0;
  double ofFound = 0.0;
  double ofExpected = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    both += found[axis] * expected[axis];
    ofFound += found[axis] * found[axis];
    ofExpected += expected[axis] * expected[axis];
  }
  EXPECT_NEAR(std::log2(ofFound / ofExpected), 0.0, 0.51);
  EXPECT_GT(both / std::sqrt(ofFound * ofExpected), 1.0 - 4e-6);
}

void ExpectLinear(const Cells& cells, const Position& slope = Slope)
{
  const auto gradients = FindOnOneRank(cells);
  ASSERT_EQ(gradients.size(), cells.Positions.size());
  for (const bricks::PackedGradient& gradient : gradients)
  {
    ExpectNear(gradient, slope);
  }
}

Cells CreateLinear(int pattern)
{
  const Cells hexahedra = CreateHexahedra(4, true);
  Cells cells = pattern < 0 ? hexahedra : Cut(hexahedra, pattern);
  cells.SetPointValues(GetLinear);
  return cells;
}

/// A function that is linear nowhere, with hidden cells, missing values, and a few flat cells.
Cells CreateRich()
{
  Cells cells = Cut(CreateHexahedra(5, true), 2);
  const Cells hexahedra = CreateHexahedra(5, true);
  cells.Corners.insert(cells.Corners.end(), hexahedra.Corners.begin(), hexahedra.Corners.end());
  for (std::uint64_t point = 0; point < 40; ++point)
  {
    cells.Corners.push_back(
      { point, point + 1, point + 7, point + 6, point, point + 1, point + 7, point + 6 });
  }
  for (std::size_t cell = 0; cell < cells.Corners.size(); ++cell)
  {
    cells.Hidden.push_back(cell % 11 == 3);
  }
  cells.SetPointValues([](const Position& position)
    { return std::sin(position[0]) * std::exp(2.0 * position[1]) + position[2] * position[2]; });
  cells.PointValues[17] = NoValue;
  cells.PointValues[100] = NoValue;
  return cells;
}

/// The bits of all points' gradients, found on so many ranks.
std::vector<std::uint32_t> FindDistributed(
  const Cells& all, int ranks, unsigned seed, int copies, int threads)
{
  std::mutex guard;
  std::vector<std::uint32_t> found(all.Positions.size(), 0);
  RunOnCluster(ranks,
    [&](dsm::Messenger& messenger)
    {
      const Piece piece = TakePiece(all, messenger.GetRank(), ranks, seed, copies);
      const auto gradients = FindGradients(piece.Own, messenger, threads);
      const std::lock_guard<std::mutex> lock(guard);
      for (std::size_t point = 0; point < piece.Points.size(); ++point)
      {
        std::uint32_t& bits = found[piece.Points[point]];
        EXPECT_TRUE(bits == 0 || bits == GetBits(gradients[point]));
        bits = GetBits(gradients[point]);
      }
    });
  return found;
}

} // namespace

TEST(PointGradients, OfALinearFunctionAreExact)
{
  for (const int pattern : { -1, 0, 1, 2 })
  {
    SCOPED_TRACE(pattern);
    ExpectLinear(CreateLinear(pattern));
  }
}

TEST(PointGradients, OfALinearFunctionInTetrahedraAreExact)
{
  Cells cells = CreateLinear(0);
  cells.AreTetrahedra = true;
  for (auto& corners : cells.Corners)
  {
    corners[3] = corners[4];
  }
  ExpectLinear(cells);
}

TEST(PointGradients, CellsMayBeInsideOut)
{
  Cells cells = CreateLinear(-1);
  for (std::size_t cell = 0; cell < cells.Corners.size(); cell += 2)
  {
    auto& corners = cells.Corners[cell];
    std::swap_ranges(corners.begin(), corners.begin() + 4, corners.begin() + 4);
  }
  ExpectLinear(cells);
}

TEST(PointGradients, CellsOfGridsAreHexahedraAmongTetrahedra)
{
  Cells cells = CreateLinear(-1);
  cells.GridCells = cells.Corners.size();
  cells.Grids.push_back({ 0, 0, bricks::Index3(5) });
  cells.AreTetrahedra = true;
  const std::uint64_t first = cells.Positions.size();
  for (const Position& position :
    { Position{ 9, 9, 9 }, Position{ 10, 9, 9 }, Position{ 9, 10, 9 }, Position{ 9, 9, 10 } })
  {
    cells.Positions.push_back(position);
  }
  cells.Corners.push_back({ first, first + 1, first + 2, first + 3 });
  cells.SetPointValues(GetLinear);
  ExpectLinear(cells);
}

TEST(PointGradients, OfAQuadraticFunctionAreExactInALattice)
{
  constexpr int n = 6;
  Cells cells = CreateHexahedra(n, false);
  cells.SetPointValues([](const Position& p)
    { return p[0] * p[0] - 2.0 * p[1] * p[1] + 0.5 * p[2] * p[2] + p[0] * p[1] - 3.0 * p[2]; });
  const auto gradients = FindOnOneRank(cells);
  int inner = 0;
  for (std::size_t point = 0; point < gradients.size(); ++point)
  {
    const Position& p = cells.Positions[point];
    if (std::all_of(p.begin(), p.end(), [](double x) { return x > 0.0 && x < n; }))
    {
      ++inner;
      ExpectNear(gradients[point], { 2.0 * p[0] + p[1], p[0] - 4.0 * p[1], p[2] - 3.0 });
    }
  }
  EXPECT_EQ(inner, (n - 1) * (n - 1) * (n - 1));
}

TEST(PointGradients, AreInTheSpaceOfTheBricks)
{
  const Cells cells = CreateLinear(-1);
  bricks::BrickSpace space;
  space.Origin = { 2.0, -64.0, 0.0 };
  space.Scale = 1024.0;
  for (const bricks::PackedGradient& gradient : FindOnOneRank(cells, space))
  {
    ExpectNear(gradient, { 1024.0 * Slope[0], 1024.0 * Slope[1], 1024.0 * Slope[2] });
  }
}

TEST(PointGradients, DoNotDependOnTheDistribution)
{
  Cells rich = CreateRich();
  const auto expected = FindDistributed(rich, 1, 1, 1, 1);
  EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](auto bits) { return bits != 0; }),
    std::ptrdiff_t(expected.size() / 2));
  for (const int ranks : { 1, 2, 3 })
  {
    for (const unsigned seed : { 2u, 3u, 4u })
    {
      for (const int copies : { 1, 3 })
      {
        EXPECT_EQ(FindDistributed(rich, ranks, seed, copies, 2), expected)
          << ranks << " ranks, seed " << seed << ", " << copies << " copies";
      }
    }
  }
}

/// More than one chunk of cells, in order and shuffled: some points are in one chunk, and some in several.
TEST(PointGradients, DoNotDependOnTheThreads)
{
  Cells cells = CreateHexahedra(32, true);
  cells.SetPointValues(
    [](const Position& p) { return std::sin(p[0]) + std::cos(0.5 * p[1]) * std::exp2(p[2]); });
  const auto expected = FindDistributed(cells, 1, 1, 1, 1);
  std::vector<std::uint32_t> inOrder;
  RunOnCluster(1,
    [&](dsm::Messenger& messenger)
    {
      for (const bricks::PackedGradient& gradient : FindGradients(cells, messenger, 4))
      {
        inOrder.push_back(GetBits(gradient));
      }
    });
  EXPECT_EQ(inOrder, expected);
  EXPECT_EQ(FindDistributed(cells, 1, 2, 1, 4), expected);
  EXPECT_EQ(FindDistributed(cells, 2, 2, 2, 2), expected);
}

TEST(PointGradients, CellsWithoutAValueDoNotCount)
{
  for (const double missing : { NoValue, std::numeric_limits<double>::infinity() })
  {
    Cells cells = CreateLinear(-1);
    cells.PointValues[62] = missing; // in the middle
    const auto gradients = FindOnOneRank(cells);
    for (std::size_t point = 0; point < gradients.size(); ++point)
    {
      if (point == 62)
      {
        EXPECT_EQ(GetBits(gradients[point]), 0u);
      }
      else
      {
        ExpectNear(gradients[point], Slope);
      }
    }
  }
}

TEST(PointGradients, HiddenCellsDoNotCount)
{
  Cells cells = CreateLinear(-1);
  cells.Hidden.resize(cells.Corners.size(), false);
  cells.Hidden[0] = true;
  cells.PointValues[0] = 1e6; // only in the first cell
  const auto gradients = FindOnOneRank(cells);
  EXPECT_EQ(GetBits(gradients[0]), 0u);
  for (std::size_t point = 1; point < gradients.size(); ++point)
  {
    ExpectNear(gradients[point], Slope);
  }
}

TEST(PointGradients, CellsWithACornerThatIsNotFiniteDoNotCount)
{
  Cells cells = CreateLinear(-1);
  cells.Positions[0] = { NoValue, 0.0, 0.0 };
  cells.Positions[124] = { 1e300, 0.0, 0.0 }; // not a float
  const auto gradients = FindOnOneRank(cells);
  EXPECT_EQ(GetBits(gradients[0]), 0u);
  EXPECT_EQ(GetBits(gradients[124]), 0u);
  for (std::size_t point = 1; point < 124; ++point)
  {
    ExpectNear(gradients[point], Slope);
  }
}

TEST(PointGradients, FlatCellsHaveNoGradient)
{
  Cells cells;
  cells.Positions = { { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 }, { 3, 3, 3 } };
  cells.Corners = { { 0, 1, 2, 3, 0, 1, 2, 3 }, { 4, 4, 4, 4, 4, 4, 4, 4 },
    { 0, 0, 1, 1, 2, 2, 3, 3 } };
  cells.PointValues = { 1.0, -5.0, 20.0, 3.0, 1.0 };
  for (const bricks::PackedGradient& gradient : FindOnOneRank(cells))
  {
    EXPECT_EQ(GetBits(gradient), 0u);
  }
}

/// Numbers of each point have a scale of their own.
TEST(PointGradients, SmallCellsAreAsPreciseAsLargeOnes)
{
  for (const double size : { 1e-12, 1e12 })
  {
    Cells cells = CreateLinear(-1);
    const std::size_t count = cells.Positions.size();
    for (auto corners : std::vector<std::array<std::uint64_t, 8>>(cells.Corners))
    {
      for (std::uint64_t& corner : corners)
      {
        corner += count;
      }
      cells.Corners.push_back(corners);
    }
    for (std::size_t point = 0; point < count; ++point)
    {
      Position position = cells.Positions[point];
      for (double& coordinate : position)
      {
        coordinate *= size;
      }
      // Around 0 where floats are as fine; the others are far away.
      cells.Positions.push_back(position);
      cells.Positions[point][0] += 1000.0;
    }
    cells.SetPointValues(
      [](const Position& p) { return p[0] * Slope[0] + p[1] * Slope[1] + p[2] * Slope[2]; });
    ExpectLinear(cells);
  }
}

TEST(PointGradients, HugeAndTinyValues)
{
  for (const double factor : { 1e-12, 1e12 })
  {
    Cells cells = CreateLinear(1);
    for (double& value : cells.PointValues)
    {
      value = (value + 7.0) * factor;
    }
    ExpectLinear(cells, { factor * Slope[0], factor * Slope[1], factor * Slope[2] });
  }
  Cells cells = CreateLinear(1);
  for (std::size_t point = 0; point < cells.PointValues.size(); ++point)
  {
    cells.PointValues[point] = point % 2 == 0 ? 1.7e308 : -1.7e308;
  }
  for (const bricks::PackedGradient& gradient : FindOnOneRank(cells))
  {
    EXPECT_EQ(GetBits(gradient), 0u);
  }
}

TEST(PointGradients, FailOnAllRanks)
{
  std::mutex guard;
  std::vector<std::string> texts;
  const Cells all = CreateRich();
  RunOnCluster(2,
    [&](dsm::Messenger& messenger)
    {
      const Piece piece = TakePiece(all, messenger.GetRank(), 2, 1);
      const bricks::BrickSpace space;
      const bricks::SharedPlaces places = FindPlaces(piece.Own, space, 2, messenger);
      try
      {
        bricks::FindPointGradients(
          "Gradients", piece.Own, space, places,
          [&](std::uint64_t) -> double
          {
            if (messenger.GetRank() == 1)
            {
              throw dsm::Error("no values");
            }
            return 0.0;
          },
          2, messenger);
      }
      catch (const dsm::Error& error)
      {
        const std::lock_guard<std::mutex> lock(guard);
        texts.emplace_back(error.what());
      }
    });
  EXPECT_EQ(texts, std::vector<std::string>(2, "Gradients: Rank 1: no values"));
}
