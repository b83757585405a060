// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/BlockHeap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <thread>
#include <utility>
#include <vector>

namespace
{

constexpr std::size_t MiB = std::size_t(1) << 20;

struct Block
{
  std::byte* Memory;
  std::size_t Bytes;
  std::byte Mark;
};

Block Make(dsm::BlockHeap& heap, std::size_t bytes, std::size_t mark)
{
  const Block block{ heap.Allocate(bytes), bytes, static_cast<std::byte>(mark) };
  std::fill_n(block.Memory, bytes, block.Mark);
  return block;
}

bool IsWhole(const Block& block)
{
  return std::all_of(
    block.Memory, block.Memory + block.Bytes, [&](std::byte byte) { return byte == block.Mark; });
}

std::vector<Block> MakeSeveral(dsm::BlockHeap& heap, std::size_t count, std::size_t bytes)
{
  std::vector<Block> blocks;
  for (std::size_t block = 0; block < count; ++block)
  {
    blocks.push_back(Make(heap, bytes, block));
  }
  return blocks;
}

void FreeAll(dsm::BlockHeap& heap, const std::vector<Block>& blocks)
{
  for (const Block& block : blocks)
  {
    heap.Free(block.Memory, block.Bytes);
  }
}

TEST(BlockHeap, BlocksAreAlignedAndApart)
{
  dsm::BlockHeap heap;
  std::vector<Block> blocks;
  for (std::size_t bytes : { 0, 1, 64, 65, 1000, 19712, 400000, 3000000 })
  {
    blocks.push_back(Make(heap, bytes, blocks.size() + 1));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(blocks.back().Memory) % dsm::BlockAlignment, 0u);
  }
  for (const Block& block : blocks)
  {
    EXPECT_TRUE(IsWhole(block)) << block.Bytes;
    heap.Free(block.Memory, block.Bytes);
  }
}

TEST(BlockHeap, AllGoesBackWithTheLastBlock)
{
  dsm::BlockHeap heap;
  std::vector<Block> blocks = MakeSeveral(heap, 1000, 20000);
  EXPECT_EQ(heap.GetBlockBytes(), 1000 * dsm::AlignBlock(20000));
  EXPECT_GE(heap.GetArenaBytes(), heap.GetBlockBytes());
  EXPECT_LE(heap.GetArenaBytes(), 2 * heap.GetBlockBytes() + MiB)
    << "arenas grow with what is in them";
  std::shuffle(blocks.begin(), blocks.end(), std::mt19937(1));
  FreeAll(heap, blocks);
  EXPECT_EQ(heap.GetBlockBytes(), 0u);
  EXPECT_EQ(heap.GetArenaBytes(), 0u);
}

TEST(BlockHeap, FreeNeighboursMakeRoomForLargerBlocks)
{
  dsm::BlockHeap heap;
  std::vector<Block> blocks = MakeSeveral(heap, 4000, 10000);
  const std::size_t before = heap.GetArenaBytes();
  // Every fifth stays: between two of them there is room for two of twice the size.
  std::vector<Block> left;
  std::size_t freed = 0;
  for (std::size_t block = 0; block < blocks.size(); ++block)
  {
    if (block % 5 == 0)
    {
      left.push_back(blocks[block]);
      continue;
    }
    heap.Free(blocks[block].Memory, blocks[block].Bytes);
    ++freed;
  }
  for (std::size_t block = 0; block < freed / 2; ++block)
  {
    left.push_back(Make(heap, 20000, block));
  }
  EXPECT_LE(heap.GetArenaBytes(), before);
  EXPECT_TRUE(std::all_of(left.begin(), left.end(), IsWhole));
  FreeAll(heap, left);
}

TEST(BlockHeap, FreePagesGoBackAndBlocksStay)
{
  dsm::BlockHeap heap;
  std::vector<Block> blocks = MakeSeveral(heap, 500, 50000);
  for (std::size_t block = 0; block < blocks.size(); block += 2)
  {
    heap.Free(blocks[block].Memory, blocks[block].Bytes);
  }
  heap.ReturnFreePages();
  for (std::size_t block = 0; block < blocks.size(); block += 2)
  {
    blocks[block] = Make(heap, 50000, block);
  }
  EXPECT_TRUE(std::all_of(blocks.begin(), blocks.end(), IsWhole));
  FreeAll(heap, blocks);
  EXPECT_EQ(heap.GetArenaBytes(), 0u);
}

/// Sizes of all kinds come and go in any order.
void ComeAndGo(dsm::BlockHeap& heap, unsigned seed, int steps)
{
  std::mt19937 random(seed);
  std::vector<Block> blocks;
  for (int step = 0; step < steps; ++step)
  {
    if (blocks.size() < 200 && (blocks.empty() || random() % 2 == 0))
    {
      blocks.push_back(Make(heap, random() % 60000, random()));
      continue;
    }
    std::swap(blocks[random() % blocks.size()], blocks.back());
    EXPECT_TRUE(IsWhole(blocks.back()));
    heap.Free(blocks.back().Memory, blocks.back().Bytes);
    blocks.pop_back();
  }
  for (const Block& block : blocks)
  {
    EXPECT_TRUE(IsWhole(block));
    heap.Free(block.Memory, block.Bytes);
  }
}

TEST(BlockHeap, ManyThreadsShareIt)
{
  dsm::BlockHeap heap;
  std::vector<std::thread> threads;
  for (unsigned seed = 0; seed < 4; ++seed)
  {
    threads.emplace_back([&heap, seed] { ComeAndGo(heap, seed, 3000); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(heap.GetBlockBytes(), 0u);
  EXPECT_EQ(heap.GetArenaBytes(), 0u);
}

} // namespace
