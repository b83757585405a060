// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMRayTracing/layout/BrickLattice.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace
{

constexpr rt::ScalarType AllTypes[] = { rt::ScalarType::Int8, rt::ScalarType::UInt8,
  rt::ScalarType::Int16, rt::ScalarType::UInt16, rt::ScalarType::Int32, rt::ScalarType::UInt32,
  rt::ScalarType::Int64, rt::ScalarType::UInt64, rt::ScalarType::Float32, rt::ScalarType::Float64 };

} // namespace

TEST(TestBrickLattice, EveryCellIsInExactlyOneBrick)
{
  const rt::BrickLattice lattice({ 20, 9, 6 }, rt::ScalarType::UInt8, false, 4);
  EXPECT_EQ(lattice.GetBricks(), rt::Index3(5, 2, 2));
  ASSERT_EQ(lattice.GetBrickCount(), 20u);
  std::set<std::tuple<int, int, int>> seen;
  for (dsm::BlockId id = 0; id < lattice.GetBrickCount(); ++id)
  {
    EXPECT_EQ(lattice.GetId(lattice.GetBrick(id)), id);
    const rt::Box cells = lattice.GetCellsOfBrick(id);
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
  const rt::BrickLattice lattice({ 20, 9, 6 }, rt::ScalarType::UInt8, false, 4);
  EXPECT_EQ(lattice.GetId({ 1, 0, 0 }), 1u);
  EXPECT_EQ(lattice.GetId({ 0, 1, 0 }), 5u);
  EXPECT_EQ(lattice.GetId({ 0, 0, 1 }), 10u);
}

TEST(TestBrickLattice, BricksAtTheUpperBorderAreSmaller)
{
  const rt::BrickLattice lattice({ 20, 9, 6 }, rt::ScalarType::UInt8, false, 4);
  const rt::Box last = lattice.GetCellsOfBrick(19);
  EXPECT_EQ(last.Min, rt::Index3(16, 4, 4));
  EXPECT_EQ(last.Max, rt::Index3(19, 8, 5));
  EXPECT_LT(lattice.GetBlockBytes(19), lattice.GetBlockBytes(0));
}

TEST(TestBrickLattice, DefaultBlocksAreAboutThePapersSize)
{
  for (const rt::ScalarType type : AllTypes)
  {
    const rt::BrickLattice lattice({ 129, 129, 129 }, type, false);
    EXPECT_GE(lattice.GetBlockBytes(0), 16u * 1024u);
    EXPECT_LE(lattice.GetBlockBytes(0), 48u * 1024u);
  }
}

TEST(TestBrickLattice, MaskTakesOneBitACell)
{
  const rt::BrickLattice plain({ 33, 33, 33 }, rt::ScalarType::Float32, false, 16);
  const rt::BrickLattice masked({ 33, 33, 33 }, rt::ScalarType::Float32, true, 16);
  EXPECT_EQ(masked.GetBlockBytes(0), plain.GetBlockBytes(0) + 16 * 16 * 16 / 8);
}

TEST(TestBrickLattice, DirectoryDealsBricksOutInTurn)
{
  const rt::BrickLattice lattice({ 20, 9, 6 }, rt::ScalarType::Float64, false, 4);
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
  EXPECT_THROW(rt::BrickLattice({ 5, 5, 1 }, rt::ScalarType::UInt8, false), dsm::Error);
  EXPECT_THROW(rt::BrickLattice({ 5, 5, 5 }, rt::ScalarType::UInt8, false, 0), dsm::Error);
  EXPECT_THROW(rt::BrickLattice({ 5, 5, 5 }, rt::ScalarType::UInt8, false, 257), dsm::Error);
}
