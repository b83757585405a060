// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/object/ObjectDigest.h"
#include "DSMRayTracing/surface/BlockLooks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace
{

using Block = rt::BlockLooks::Block;

/// Boxes that fill a lattice of 24^3 cells, some of them left out, in any order; each has a color of its own.
std::vector<Block> MakeBlocks(std::mt19937& random, std::int64_t edge)
{
  std::vector<Block> blocks;
  for (std::int64_t z = 0; z < 24; z += edge)
  {
    for (std::int64_t y = 0; y < 24; y += edge)
    {
      for (std::int64_t x = 0; x < 24; x += edge)
      {
        Block block;
        block.Cells = { { x, y, z }, { x + edge, y + edge, z + edge } };
        block.Appearance.Color = glm::vec4(x, y, z, 1.0f);
        if (random() % 8 != 0)
        {
          blocks.push_back(block);
        }
      }
    }
  }
  std::shuffle(blocks.begin(), blocks.end(), random);
  return blocks;
}

bool Holds(const bricks::Box& box, const bricks::Index3& cell)
{
  return !bricks::Intersect(box, { cell, cell + bricks::Index3(1) }).IsEmpty();
}

std::uint64_t GetDigest(const std::vector<Block>& blocks)
{
  rt::ObjectDigest digest;
  rt::BlockLooks(blocks).AddTo(digest);
  return digest.Get();
}

Block MakeBlock(const rt::BlockLooks::Look& look)
{
  return { { { 0, 0, 0 }, { 2, 2, 2 } }, look };
}

TEST(BlockLooks, TheBlockOfACellIsFound)
{
  std::mt19937 random(5);
  for (const std::int64_t edge : { 24, 12, 6, 3 })
  {
    const std::vector<Block> blocks = MakeBlocks(random, edge);
    const rt::BlockLooks looks(blocks);
    for (int trial = 0; trial < 2000; ++trial)
    {
      const auto draw = [&] { return static_cast<std::int64_t>(random() % 26) - 1; };
      const bricks::Index3 cell(draw(), draw(), draw());
      const auto expected = std::find_if(
        blocks.begin(), blocks.end(), [&](const Block& block) { return Holds(block.Cells, cell); });
      const rt::BlockLooks::Look* found = looks.Find(cell);
      ASSERT_EQ(found != nullptr, expected != blocks.end());
      if (found)
      {
        EXPECT_EQ(*found->Color, *expected->Appearance.Color);
      }
    }
  }
}

TEST(BlockLooks, WithoutBlocksNoneIsFound)
{
  const rt::BlockLooks looks({ Block{ { { 3, 0, 0 }, { 3, 5, 5 } }, {} } });
  EXPECT_EQ(looks.Find({ 3, 1, 1 }), nullptr);
  EXPECT_TRUE(looks.AreOpaque());
  EXPECT_FALSE(looks.AnyIsSeen());
}

TEST(BlockLooks, OpacitiesOfBlocksAndOfTheirColorsCount)
{
  EXPECT_TRUE(rt::BlockLooks({ MakeBlock({ glm::vec4(1.0f), 1.0f }) }).AreOpaque());
  EXPECT_FALSE(rt::BlockLooks({ MakeBlock({ glm::vec4(1.0f), 0.5f }) }).AreOpaque());
  EXPECT_FALSE(rt::BlockLooks({ MakeBlock({ glm::vec4(0.5f), {} }) }).AreOpaque());
  EXPECT_FALSE(rt::BlockLooks({ MakeBlock({ glm::vec4(1.0f), {} }) }).AnyIsSeen());
  EXPECT_TRUE(rt::BlockLooks({ MakeBlock({ {}, 0.5f }) }).AnyIsSeen());
}

TEST(BlockLooks, TheDigestTellsLooksApart)
{
  const Block block = MakeBlock({ glm::vec4(1.0f), {} });
  Block moved = block;
  moved.Cells.Max.x = 3;
  EXPECT_EQ(GetDigest({ block }), GetDigest({ block }));
  EXPECT_NE(GetDigest({ block }), GetDigest({ moved }));
  EXPECT_NE(GetDigest({ block }), GetDigest({ MakeBlock({ glm::vec4(0.5f), {} }) }));
  EXPECT_NE(GetDigest({ block }), GetDigest({ MakeBlock({ glm::vec4(1.0f), 1.0f }) }));
}

} // namespace
