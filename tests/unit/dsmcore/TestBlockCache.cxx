// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/BlockCache.h"

#include "DSMCore/base/Block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace
{

using dsm::LineState;

constexpr std::size_t Bytes = 128;
constexpr std::uint64_t Never = 0;
constexpr std::uint64_t Always = ~std::uint64_t(0);

class BlockCacheOfThree : public testing::Test
{
protected:
  BlockCacheOfThree()
    : Lines(8)
    , Content(Bytes)
  {
    this->Cache.SetCapacity(3 * Bytes);
    for (auto& line : this->Lines)
    {
      line.Bytes = Bytes;
    }
  }

  bool Fetch(std::size_t index)
  {
    if (!this->Cache.TryReserve(Bytes))
    {
      return false;
    }
    dsm::BlockLine& line = this->Lines[index];
    line.MoveTo(LineState::Wanted);
    line.MoveTo(LineState::Pending);
    this->Content.assign(Bytes, static_cast<std::byte>(index));
    dsm::BlockMemory memory = dsm::AllocateBlock(Bytes);
    std::copy(this->Content.begin(), this->Content.end(), memory.get());
    this->Cache.PrepareSlot();
    this->Cache.Insert(line, std::move(memory));
    return true;
  }

  void Fill() { EXPECT_TRUE(this->Fetch(0) && this->Fetch(1) && this->Fetch(2)); }

  std::vector<dsm::BlockLine> Lines;
  std::vector<std::byte> Content;
  dsm::BlockCache Cache;
};

TEST_F(BlockCacheOfThree, InsertedBlockIsAlignedAndKeepsItsBytes)
{
  EXPECT_TRUE(this->Fetch(1));
  const std::byte* const address = this->Lines[1].Address;
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(address) % dsm::BlockAlignment, 0u);
  EXPECT_EQ(std::vector<std::byte>(address, address + Bytes), this->Content);
  EXPECT_EQ(this->Lines[1].State, LineState::Cached);
}

TEST_F(BlockCacheOfThree, BudgetIsNeverExceeded)
{
  this->Fill();
  EXPECT_FALSE(this->Fetch(3));
  EXPECT_EQ(this->Cache.GetUsed(), 3 * Bytes);
  EXPECT_EQ(this->Cache.Evict(Bytes, 0, 2).Count, 1u);
  EXPECT_FALSE(this->Fetch(3)) << "memory in limbo is not free";
  EXPECT_FALSE(this->Cache.Reclaim(1));
  EXPECT_TRUE(this->Cache.Reclaim(2));
  EXPECT_TRUE(this->Fetch(3));
  EXPECT_EQ(this->Cache.GetPeak(), 3 * Bytes);
}

TEST_F(BlockCacheOfThree, ReferencedBlocksGetASecondChance)
{
  this->Fill();
  this->Lines[0].Use = dsm::BlockUse::Recent;
  EXPECT_EQ(this->Cache.Evict(Bytes, 0, 1).Count, 1u);
  EXPECT_EQ(this->Lines[1].State, LineState::Absent);
  EXPECT_EQ(this->Lines[1].Address, nullptr);
  EXPECT_EQ(this->Lines[0].State, LineState::Cached);
  EXPECT_EQ(this->Lines[0].Use, dsm::BlockUse::Idle);
}

TEST_F(BlockCacheOfThree, AllReferencedStillYieldsOne)
{
  this->Fill();
  for (auto& line : this->Lines)
  {
    line.Use = dsm::BlockUse::Recent;
  }
  EXPECT_EQ(this->Cache.Evict(Bytes, 0, 1).Count, 1u);
}

TEST_F(BlockCacheOfThree, AwaitedBlocksStay)
{
  this->Fill();
  for (auto& line : this->Lines)
  {
    line.Waiters = 1;
  }
  EXPECT_EQ(this->Cache.Evict(Bytes, 0, 1).Count, 0u);
  this->Lines[2].Waiters = 0;
  EXPECT_EQ(this->Cache.Evict(Bytes, 0, 1).Count, 1u);
  EXPECT_EQ(this->Lines[2].State, LineState::Absent);
}

TEST_F(BlockCacheOfThree, LimboCountsAsRoomToCome)
{
  this->Fill();
  EXPECT_EQ(this->Cache.Evict(Bytes, 0, 1).Count, 1u);
  EXPECT_EQ(this->Cache.Evict(Bytes, 0, 2).Count, 0u) << "one is enough for one block";
  EXPECT_EQ(this->Cache.Evict(Bytes, Bytes, 2).Count, 1u);
}

TEST_F(BlockCacheOfThree, ReleasedRoomIsFree)
{
  EXPECT_TRUE(this->Cache.TryReserve(2 * Bytes));
  EXPECT_FALSE(this->Cache.TryReserve(2 * Bytes));
  this->Cache.Release(2 * Bytes);
  EXPECT_TRUE(this->Cache.TryReserve(3 * Bytes));
  this->Cache.Release(3 * Bytes);
  EXPECT_EQ(this->Cache.GetUsed(), 0u);
}

TEST_F(BlockCacheOfThree, EmptyBlockTakesRoomToo)
{
  EXPECT_EQ(dsm::GetBlockFootprint(0), dsm::BlockAlignment);
  EXPECT_EQ(dsm::GetBlockFootprint(65), 2 * dsm::BlockAlignment);
}

TEST_F(BlockCacheOfThree, ForgetDropsOnlyTheGivenLines)
{
  this->Fill();
  this->Cache.Forget(this->Lines.data(), 2);
  EXPECT_EQ(this->Lines[0].State, LineState::Absent);
  EXPECT_EQ(this->Lines[1].State, LineState::Absent);
  EXPECT_EQ(this->Lines[2].State, LineState::Cached);
  EXPECT_EQ(this->Cache.GetUsed(), Bytes);
}

TEST_F(BlockCacheOfThree, ShrinkMeetsTheBudget)
{
  this->Fill();
  this->Lines[0].Use = dsm::BlockUse::Recent;
  this->Cache.SetCapacity(Bytes);
  this->Cache.Shrink();
  EXPECT_EQ(this->Cache.GetUsed(), Bytes);
  EXPECT_EQ(this->Lines[0].State, LineState::Cached);
  this->Cache.SetCapacity(0);
  this->Cache.Shrink();
  EXPECT_EQ(this->Cache.GetUsed(), 0u);
}

TEST_F(BlockCacheOfThree, NothingToEvict)
{
  EXPECT_EQ(this->Cache.Evict(4 * Bytes, 0, Never).Count, 0u);
  EXPECT_FALSE(this->Cache.Reclaim(Always));
  EXPECT_FALSE(this->Cache.HasLimbo());
}

TEST_F(BlockCacheOfThree, SlotsAreReused)
{
  for (std::size_t round = 0; round < 100; ++round)
  {
    const std::size_t index = round % this->Lines.size();
    if (this->Lines[index].State == LineState::Cached)
    {
      continue;
    }
    while (!this->Fetch(index))
    {
      EXPECT_EQ(this->Cache.Evict(Bytes, 0, 1).Count, 1u);
      this->Cache.Reclaim(Always);
    }
    EXPECT_LE(this->Cache.GetUsed(), 3 * Bytes);
  }
}

} // namespace
