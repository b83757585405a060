// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/BlockArena.h"

#include "DSMCore/base/Block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <utility>

namespace
{

TEST(BlockArena, IsZeroedAndAligned)
{
  const dsm::BlockArena arena(1000000);
  EXPECT_EQ(arena.GetBytes(), 1000000u);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(arena.GetData()) % dsm::BlockAlignment, 0u);
  EXPECT_TRUE(std::all_of(arena.GetData(), arena.GetData() + arena.GetBytes(),
    [](std::byte byte) { return byte == std::byte{ 0 }; }));
}

TEST(BlockArena, NoBytesHaveAnAddressToo)
{
  const dsm::BlockArena arena(0);
  EXPECT_NE(arena.GetData(), nullptr);
}

TEST(BlockArena, MoreThanThereIsThrowsBadAlloc)
{
  EXPECT_THROW(dsm::BlockArena(std::size_t(1) << 60), std::bad_alloc);
}

TEST(BlockArena, MovesWithItsMemory)
{
  dsm::BlockArena first(100);
  std::byte* const data = first.GetData();
  data[3] = std::byte{ 9 };
  dsm::BlockArena second(std::move(first));
  EXPECT_EQ(second.GetData(), data);
  dsm::BlockArena third;
  EXPECT_EQ(third.GetData(), nullptr);
  third = std::move(second);
  EXPECT_EQ(third.GetData()[3], std::byte{ 9 });
}

} // namespace
