// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/BrickLattice.h"
#include "DSMCore/base/Error.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace
{

constexpr bricks::ScalarType AllTypes[] = { bricks::ScalarType::Int8, bricks::ScalarType::UInt8,
  bricks::ScalarType::Int16, bricks::ScalarType::UInt16, bricks::ScalarType::Int32,
  bricks::ScalarType::UInt32, bricks::ScalarType::Int64, bricks::ScalarType::UInt64,
  bricks::ScalarType::Float32, bricks::ScalarType::Float64 };

} // namespace

TEST(TestBrickLattice, EveryCellIsInExactlyOneBrick)
{
  const bricks::BrickLattice lattice({ 20, 9, 6 }, bricks::ScalarType::UInt8, false, 4);
  EXPECT_EQ(lattice.GetBricks(), bricks::Index3(5, 2, 2));
  ASSERT_EQ(lattice.GetBrickCount(), 20u);
  std::set<std::tuple<int, int, int>> seen;
  for (dsm::BlockId id = 0; id < lattice.GetBrickCount(); ++id)
  {
    EXPECT_EQ(lattice.GetId(lattice.GetBrick(id)), id);
    const bricks::Box cells = lattice.GetCellsOfBrick(id);
    for (auto z = cells.Min.z; z < cells.Max.z; ++z)
    {
      for (auto y = cells.Min.y; y < cells.Max.y; ++y)
      {
        for (auto x = cells.Min.x; x < cells.Max.x; ++x)
        {
          EXPECT_TRUE(seen.insert({ x, y, z }).second);
        }
      }
    }
  }
  EXPECT_EQ(seen.size(), 19u * 8u * 5u);
}

TEST(TestBrickLattice, IdsRunAlongXFirst)
{
  const bricks::BrickLattice lattice({ 20, 9, 6 }, bricks::ScalarType::UInt8, false, 4);
  EXPECT_EQ(lattice.GetId({ 1, 0, 0 }), 1u);
  EXPECT_EQ(lattice.GetId({ 0, 1, 0 }), 5u);
  EXPECT_EQ(lattice.GetId({ 0, 0, 1 }), 10u);
}

TEST(TestBrickLattice, BricksAtTheUpperBorderAreSmaller)
{
  const bricks::BrickLattice lattice({ 20, 9, 6 }, bricks::ScalarType::UInt8, false, 4);
  const bricks::Box last = lattice.GetCellsOfBrick(19);
  EXPECT_EQ(last.Min, bricks::Index3(16, 4, 4));
  EXPECT_EQ(last.Max, bricks::Index3(19, 8, 5));
  EXPECT_LT(lattice.GetBlockBytes(19), lattice.GetBlockBytes(0));
}

TEST(TestBrickLattice, DefaultBlocksAreAboutThePapersSize)
{
  for (const bricks::ScalarType type : AllTypes)
  {
    const bricks::BrickLattice lattice({ 129, 129, 129 }, type, false);
    EXPECT_GE(lattice.GetBlockBytes(0), 16u * 1024u);
    EXPECT_LE(lattice.GetBlockBytes(0), 48u * 1024u);
  }
}

TEST(TestBrickLattice, MaskTakesOneBitACell)
{
  const bricks::BrickLattice plain({ 33, 33, 33 }, bricks::ScalarType::Float32, false, 16);
  const bricks::BrickLattice masked({ 33, 33, 33 }, bricks::ScalarType::Float32, true, 16);
  EXPECT_EQ(masked.GetBlockBytes(0), plain.GetBlockBytes(0) + 16 * 16 * 16 / 8);
}

TEST(TestBrickLattice, DirectoryDealsBricksOutInTurn)
{
  const bricks::BrickLattice lattice({ 20, 9, 6 }, bricks::ScalarType::Float64, false, 4);
  const dsm::BlockDirectory directory = lattice.CreateDirectory(3);
  ASSERT_EQ(directory.GetCount(), 20u);
  for (dsm::BlockId id = 0; id < 20; ++id)
  {
    EXPECT_EQ(directory.GetOwner(id), static_cast<int>(id % 3));
    EXPECT_EQ(directory.GetBytes(id), lattice.GetBlockBytes(id));
  }
}

TEST(TestBrickLattice, RefusesSlicesAndBadEdges)
{
  EXPECT_THROW(bricks::BrickLattice({ 5, 5, 1 }, bricks::ScalarType::UInt8, false), dsm::Error);
  EXPECT_THROW(bricks::BrickLattice({ 5, 5, 5 }, bricks::ScalarType::UInt8, false, 0), dsm::Error);
  EXPECT_THROW(
    bricks::BrickLattice({ 5, 5, 5 }, bricks::ScalarType::UInt8, false, 257), dsm::Error);
}
