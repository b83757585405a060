// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/PageLayout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace
{

constexpr std::size_t Page = 4096;

/// Every block in its owner's share, no two on one page, all found by their addresses.
void CheckLayout(const dsm::BlockDirectory& directory, int owners)
{
  const dsm::PageLayout layout(directory, owners, Page);
  std::vector<std::pair<std::uint64_t, std::uint64_t>> places;
  std::uint64_t pages = 0;
  for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
  {
    const std::uint64_t begin = layout.GetOffset(id);
    const std::uint64_t end = begin + layout.GetFootprint(id);
    const int owner = directory.GetOwner(id);
    EXPECT_EQ(begin % Page, 0u);
    EXPECT_EQ(layout.GetFootprint(id), (directory.GetBytes(id) + Page - 1) / Page * Page);
    EXPECT_GE(begin, layout.GetShareBegin(owner));
    EXPECT_LE(end, layout.GetShareEnd(owner));
    places.emplace_back(begin, end);
    pages += end - begin;
    dsm::BlockId found = 0;
    if (end > begin)
    {
      EXPECT_TRUE(layout.Find(begin, found));
      EXPECT_EQ(found, id);
      EXPECT_TRUE(layout.Find(end - 1, found));
      EXPECT_EQ(found, id);
    }
  }
  std::sort(places.begin(), places.end());
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    EXPECT_LE(places[i - 1].second, places[i].first);
  }
  std::uint64_t reachable = 0;
  for (std::uint64_t offset = 0; offset < layout.GetBytes(); offset += Page)
  {
    dsm::BlockId found = 0;
    reachable += layout.Find(offset, found) ? Page : 0;
  }
  EXPECT_EQ(reachable, pages);
  dsm::BlockId none = 0;
  EXPECT_FALSE(layout.Find(layout.GetBytes(), none));
}

TEST(PageLayout, BlocksOfOneSize)
{
  for (const int owners : { 1, 2, 3, 4, 7, 31 })
  {
    for (const std::size_t count : { 0, 1, 6, 7, 100 })
    {
      CheckLayout(dsm::BlockDirectory(std::vector<std::uint32_t>(count, 3 * Page - 5),
                    dsm::RoundRobinAssigner(owners)),
        owners);
    }
  }
}

TEST(PageLayout, BlocksOfAboutOneSize)
{
  std::vector<std::uint32_t> bytes(200, 9 * Page);
  for (std::size_t i = 5; i < bytes.size(); i += 13)
  {
    bytes[i] = 7 * Page - 1;
  }
  CheckLayout(dsm::BlockDirectory(bytes, dsm::RoundRobinAssigner(3)), 3);
}

TEST(PageLayout, BlocksOfVariousSizes)
{
  const std::vector<std::uint32_t> bytes = { 0, 1, 63, Page, Page + 1, 2 * Page, 300001, 12, 5000,
    0, 777, 80 * Page };
  for (const int owners : { 1, 2, 3, 5, 20 })
  {
    CheckLayout(dsm::BlockDirectory(bytes, dsm::RoundRobinAssigner(owners)), owners);
  }
}

TEST(PageLayout, FewerOwnersThanRanks)
{
  CheckLayout(
    dsm::BlockDirectory(std::vector<std::uint32_t>(9, 100), dsm::RoundRobinAssigner(2)), 4);
}

TEST(PageLayout, NothingButEmptyBlocks)
{
  CheckLayout(dsm::BlockDirectory(std::vector<std::uint32_t>(9, 0), dsm::RoundRobinAssigner(2)), 2);
}

/// Four billion pages; the offsets' arithmetic is exact up there.
TEST(PageLayout, MoreThanThirtyTwoBitsOfAddresses)
{
  const std::uint32_t bytes = std::uint32_t(1) << 31;
  const dsm::BlockDirectory directory(
    std::vector<std::uint32_t>(3000, bytes), dsm::RoundRobinAssigner(7));
  const dsm::PageLayout layout(directory, 7, Page);
  for (dsm::BlockId id = 0; id < 3000; ++id)
  {
    dsm::BlockId found = 0;
    ASSERT_TRUE(layout.Find(layout.GetOffset(id) + bytes - 1, found));
    ASSERT_EQ(found, id);
  }
  EXPECT_GE(layout.GetBytes(), 3000 * std::uint64_t(bytes));
}

} // namespace
