// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/layout/MacrocellHierarchy.h"
#include "DSMBricks/layout/VoxelBrickHeader.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/transport/LoopbackTransport.h"
#include "tests/support/LimitedCluster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace
{

constexpr int Bricks[3] = { 10, 3, 17 };

bricks::BrickLattice CreateLattice()
{
  return bricks::BrickLattice(
    { 4 * Bricks[0] + 1, 4 * Bricks[1], 4 * Bricks[2] - 2 }, bricks::ScalarType::Float32, false, 4);
}

bricks::ValueRange CreateRange(dsm::BlockId id)
{
  const auto value = static_cast<float>(id * 37 % 101);
  return { value, value + static_cast<float>(id % 7) };
}

std::vector<bricks::ValueRange> CreateRanges(const bricks::BrickLattice& lattice)
{
  std::vector<bricks::ValueRange> ranges;
  for (dsm::BlockId id = 0; id < lattice.GetBrickCount(); ++id)
  {
    ranges.push_back(CreateRange(id));
  }
  return ranges;
}

/// The blocks of one of several ranks; only their headers.
class HeaderSegment final : public dsm::BlockSegment
{
public:
  HeaderSegment(const bricks::BrickLattice& lattice, int rank, int ranks)
    : BlockSegment(0, lattice.CreateDirectory(ranks))
    , Rank(rank)
  {
  }
  void ForEachResident(const Visit& visit) const override
  {
    for (dsm::BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
    {
      if (this->GetDirectory().GetOwner(id) == this->Rank)
      {
        bricks::VoxelBrickHeader header{};
        header.First = CreateRange(id).First;
        header.Last = CreateRange(id).Last;
        visit(id, reinterpret_cast<const std::byte*>(&header), sizeof(header));
      }
    }
  }
  std::uint64_t GetResidentBytes() const override { return 0; }
  std::byte* GetOwned(dsm::BlockId) const override { return nullptr; }
  void Seal() override {}

private:
  int Rank;
};

} // namespace

TEST(TestMacrocellHierarchy, EachLevelSpansTheOneBelow)
{
  const bricks::BrickLattice lattice = CreateLattice();
  const bricks::MacrocellHierarchy hierarchy(lattice, CreateRanges(lattice));
  const auto& levels = hierarchy.GetLevels();
  ASSERT_EQ(levels.size(), 4u);
  EXPECT_EQ(levels[1].Size[0], 3);
  EXPECT_EQ(levels[1].Size[1], 1);
  EXPECT_EQ(levels[1].Size[2], 5);
  EXPECT_EQ(levels[3].Ranges.size(), 1u);
  EXPECT_EQ(levels[2].Edge, 64.0);
  for (std::size_t level = 0; level < levels.size(); ++level)
  {
    const auto& macrocells = levels[level];
    std::vector<bricks::ValueRange> expected(macrocells.Ranges.size(), { 1e30f, -1e30f });
    for (dsm::BlockId id = 0; id < lattice.GetBrickCount(); ++id)
    {
      const bricks::Index3 place = lattice.GetBrick(id) >> bricks::Index3(2 * level);
      auto& range = expected[static_cast<std::size_t>(
        place.x + macrocells.Size[0] * (place.y + macrocells.Size[1] * place.z))];
      range.First = std::min(range.First, CreateRange(id).First);
      range.Last = std::max(range.Last, CreateRange(id).Last);
    }
    for (std::size_t i = 0; i < expected.size(); ++i)
    {
      EXPECT_EQ(macrocells.Ranges[i].First, expected[i].First);
      EXPECT_EQ(macrocells.Ranges[i].Last, expected[i].Last);
    }
  }
  EXPECT_EQ(hierarchy.GetRange().First, 0.0f);
  std::uint64_t bytes = 0;
  for (const auto& level : levels)
  {
    bytes += level.Ranges.size() * sizeof(bricks::ValueRange);
  }
  EXPECT_EQ(bricks::MacrocellHierarchy::CountBytes(lattice), bytes);
  EXPECT_EQ(lattice.CreateDirectory(2).GetOwnBytes(), lattice.GetBrickCount() * 4 + bytes);
}

TEST(TestMacrocellHierarchy, EveryRankGathersAllRanges)
{
  const bricks::BrickLattice lattice = CreateLattice();
  for (const int ranks : { 1, 2, 3, 4 })
  {
    auto transports = dsm::LoopbackTransport::CreateGroup(ranks);
    std::vector<bricks::MacrocellHierarchy> hierarchies(ranks);
    std::vector<std::thread> threads;
    for (int rank = 0; rank < ranks; ++rank)
    {
      threads.emplace_back(
        [&, rank]
        {
          dsm::Messenger messenger(std::move(transports[rank]));
          hierarchies[rank] =
            bricks::MacrocellHierarchy(lattice, HeaderSegment(lattice, rank, ranks), messenger);
          messenger.Barrier();
        });
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
    for (const bricks::MacrocellHierarchy& hierarchy : hierarchies)
    {
      const auto& finest = hierarchy.GetLevels().front().Ranges;
      ASSERT_EQ(finest.size(), lattice.GetBrickCount());
      for (dsm::BlockId id = 0; id < finest.size(); ++id)
      {
        ASSERT_EQ(finest[id].First, CreateRange(id).First);
        ASSERT_EQ(finest[id].Last, CreateRange(id).Last);
      }
    }
  }
}

/// 8 bytes a brick are more than a message carries, for a lattice that is large enough.
TEST(TestMacrocellHierarchy, GathersMoreThanAMessageCarries)
{
  const bricks::BrickLattice lattice = CreateLattice();
  constexpr std::size_t pieceBytes = 200;
  ASSERT_GT(sizeof(bricks::ValueRange) * lattice.GetBrickCount(), 4 * pieceBytes);
  for (const int ranks : { 1, 2, 3, 4 })
  {
    RunOnLimitedCluster(ranks, pieceBytes,
      [&](dsm::Messenger& messenger)
      {
        const bricks::MacrocellHierarchy hierarchy(
          lattice, HeaderSegment(lattice, messenger.GetRank(), ranks), messenger);
        const auto& finest = hierarchy.GetLevels().front().Ranges;
        ASSERT_EQ(finest.size(), lattice.GetBrickCount());
        for (dsm::BlockId id = 0; id < finest.size(); ++id)
        {
          ASSERT_EQ(finest[id].First, CreateRange(id).First);
          ASSERT_EQ(finest[id].Last, CreateRange(id).Last);
        }
      });
  }
}

TEST(TestMacrocellHierarchy, RefusesRangesOfAnotherLattice)
{
  EXPECT_THROW(
    bricks::MacrocellHierarchy(CreateLattice(), std::vector<bricks::ValueRange>(5)), dsm::Error);
}

TEST(TestMacrocellHierarchy, RangeHoldsIsovaluesAboveItsFirst)
{
  const bricks::ValueRange range{ 1.0f, 2.0f };
  EXPECT_FALSE(range.MayHold(1.0));
  EXPECT_TRUE(range.MayHold(1.5));
  EXPECT_TRUE(range.MayHold(2.0));
  EXPECT_FALSE(range.MayHold(2.0000001));
  EXPECT_FALSE((bricks::ValueRange{ 1.0f, -1.0f }).MayHold(0.0));
}
