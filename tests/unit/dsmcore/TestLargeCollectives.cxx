// SPDX-License-Identifier: BSD-3-Clause
// Collectives of more than a message can carry.
#include "tests/support/LimitedCluster.h"
#include "tests/unit/dsmcore/MessengerScenarios.h"

#include <cstdint>
#include <vector>

namespace
{

class LargeCollectives : public testing::TestWithParam<int>
{
protected:
  static constexpr std::size_t PieceBytes = 200;

  void Run(const std::function<void(dsm::Messenger&)>& program) const
  {
    RunOnLimitedCluster(this->GetParam(), PieceBytes, program);
  }
};

INSTANTIATE_TEST_SUITE_P(
  Ranks, LargeCollectives, testing::Values(1, 3, 8), testing::PrintToStringParamName());

TEST_P(LargeCollectives, GatherKeepsRankOrderAndSizes)
{
  this->Run(
    [](dsm::Messenger& messenger)
    {
      // Below, at and above the limit; of all ranks, of the first, of the last.
      for (const std::size_t bytes : { 20, 199, 200, 201, 400, 12345 })
      {
        for (int only = -1; only < messenger.GetSize(); ++only)
        {
          const auto count = [=](int rank)
          { return only < 0 || rank == only ? bytes + static_cast<std::size_t>(rank) : 0; };
          const int own = messenger.GetRank();
          const auto parts = messenger.AllGather(dsm_test::MakeBytes(count(own), own));
          ASSERT_EQ(static_cast<int>(parts.size()), messenger.GetSize());
          for (int rank = 0; rank < messenger.GetSize(); ++rank)
          {
            EXPECT_EQ(
              parts[static_cast<std::size_t>(rank)], dsm_test::MakeBytes(count(rank), rank));
          }
        }
      }
    });
}

TEST_P(LargeCollectives, WhatRankZeroGathersIsThereAndNowhereElse)
{
  this->Run(
    [](dsm::Messenger& messenger)
    {
      for (const std::size_t bytes : { 20, 199, 200, 201, 12345 })
      {
        for (int without = -1; without < messenger.GetSize(); ++without)
        {
          const auto give = [=](int rank) {
            return dsm_test::MakeBytes(
              rank == without ? 0 : bytes + static_cast<std::size_t>(rank), rank);
          };
          const int own = messenger.GetRank();
          const auto parts = messenger.GatherOnRankZero("Gathering", [&] { return give(own); });
          ASSERT_EQ(static_cast<int>(parts.size()), messenger.GetSize());
          for (int rank = 0; rank < messenger.GetSize(); ++rank)
          {
            EXPECT_EQ(parts[static_cast<std::size_t>(rank)],
              own == 0 ? give(rank) : std::vector<std::byte>());
          }
        }
      }
    });
}

TEST_P(LargeCollectives, WhatRankZeroCannotBeGivenFailsOnAll)
{
  this->Run(
    [](dsm::Messenger& messenger)
    {
      const int last = messenger.GetSize() - 1;
      const auto give = [&]() -> std::vector<std::byte>
      {
        if (messenger.GetRank() == last)
        {
          throw dsm::Error("there is none");
        }
        return dsm_test::MakeBytes(5000, 5);
      };
      EXPECT_THROW(messenger.GatherOnRankZero("Gathering", give), dsm::Error);
      messenger.Barrier();
    });
}

TEST_P(LargeCollectives, BroadcastReachesAll)
{
  this->Run(
    [](dsm::Messenger& messenger)
    {
      const auto mine = dsm_test::MakeBytes(messenger.GetRank() == 0 ? 5000 : 7000, 5);
      EXPECT_EQ(messenger.Broadcast(mine), dsm_test::MakeBytes(5000, 5));
    });
}

TEST_P(LargeCollectives, SumsAreOverAllRanks)
{
  this->Run(
    [](dsm::Messenger& messenger)
    {
      for (const std::size_t count : { 0, 1, 24, 25, 26, 5000 })
      {
        std::vector<std::uint64_t> numbers(count);
        std::vector<std::uint64_t> sums(count, 0);
        for (std::size_t index = 0; index < count; ++index)
        {
          const auto number = [=](int rank)
          { return (std::uint64_t(1) << 40) + index * static_cast<std::uint64_t>(rank + 3); };
          numbers[index] = number(messenger.GetRank());
          for (int rank = 0; rank < messenger.GetSize(); ++rank)
          {
            sums[index] += number(rank);
          }
        }
        messenger.Sum(numbers);
        EXPECT_EQ(numbers, sums);
      }
    });
}

TEST_P(LargeCollectives, SumOfDifferentNumbersOfNumbersIsRefusedByAll)
{
  if (this->GetParam() == 1)
  {
    GTEST_SKIP() << "a rank alone has as many as all";
  }
  this->Run(
    [](dsm::Messenger& messenger)
    {
      std::vector<std::uint64_t> numbers(messenger.GetRank() == 0 ? 3 : 2, 1);
      EXPECT_THROW(messenger.Sum(numbers), dsm::Error);
      messenger.Barrier();
    });
}

} // namespace
