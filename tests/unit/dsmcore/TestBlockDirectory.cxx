// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/BlockDirectory.h"

#include <gtest/gtest.h>

namespace
{

TEST(RoundRobinAssigner, DealsBlocksInTurn)
{
  const dsm::RoundRobinAssigner assigner(3);
  for (dsm::BlockId id = 0; id < 9; ++id)
  {
    EXPECT_EQ(assigner.GetOwner(id), static_cast<int>(id % 3));
  }
}

TEST(BlockDirectory, SumsPerOwnerAreAligned)
{
  dsm::BlockDirectory directory({ 1, 64, 65, 0 }, dsm::RoundRobinAssigner(2));
  EXPECT_EQ(directory.GetCount(), 4u);
  EXPECT_EQ(directory.GetBytes(2), 65u);
  EXPECT_EQ(directory.GetLargest(), 65u);
  EXPECT_EQ(directory.GetTotalBytes(), 130u);
  EXPECT_EQ(directory.GetResidentBytes(0), 64u + 128u);
  EXPECT_EQ(directory.GetResidentBytes(1), 64u);
  directory.SetFromSource();
  EXPECT_EQ(directory.GetTotalBytes(), 130u);
  EXPECT_EQ(directory.GetResidentBytes(0), 0u) << "no owner holds what is read from its source";
}

TEST(BlockDirectory, SumsDoNotOverflow32Bits)
{
  const dsm::BlockDirectory directory(
    std::vector<std::uint32_t>(3, 0xfffffff0u), dsm::RoundRobinAssigner(1));
  EXPECT_EQ(directory.GetTotalBytes(), 3 * std::uint64_t(0xfffffff0u));
  EXPECT_EQ(directory.GetResidentBytes(0), 3 * (std::uint64_t(1) << 32));
}

TEST(BlockDirectory, NoBlocks)
{
  const dsm::BlockDirectory directory({}, dsm::RoundRobinAssigner(4));
  EXPECT_EQ(directory.GetCount(), 0u);
  EXPECT_EQ(directory.GetLargest(), 0u);
  EXPECT_EQ(directory.GetTotalBytes(), 0u);
  EXPECT_EQ(directory.GetResidentBytes(3), 0u);
}

} // namespace
