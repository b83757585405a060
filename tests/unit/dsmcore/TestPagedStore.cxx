// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/PagedStore.h"

#include "tests/unit/dsmcore/PagedScenarios.h"

namespace
{

using Parameters = std::tuple<int, dsm_test::Way>;

class PagedStoreOnLoopback : public testing::TestWithParam<Parameters>
{
protected:
  void SetUp() override
  {
    const std::string refusal = std::get<dsm_test::Way>(this->GetParam()).GetRefusal();
    if (!refusal.empty())
    {
      GTEST_SKIP() << refusal;
    }
  }

  void Run(void (*scenario)(dsm::Messenger&, const dsm_test::Way&))
  {
    const auto [ranks, way] = this->GetParam();
    dsm_test::RunRanks(
      ranks, [&, way = way](dsm::Messenger& messenger) { scenario(messenger, way); });
  }
};

INSTANTIATE_TEST_SUITE_P(Ranks, PagedStoreOnLoopback,
  testing::Combine(testing::Values(1, 3), testing::ValuesIn(dsm_test::GetAllWays())),
  [](const testing::TestParamInfo<Parameters>& parameters)
  {
    return std::to_string(std::get<int>(parameters.param)) +
      std::get<dsm_test::Way>(parameters.param).GetName();
  });

#define RUN_SCENARIO(scenario)                                                                     \
  TEST_P(PagedStoreOnLoopback, scenario)                                                           \
  {                                                                                                \
    this->Run(dsm_test::Paged##scenario);                                                          \
  }

RUN_SCENARIO(EveryByteArrives)
RUN_SCENARIO(NoBlocksAtAll)
RUN_SCENARIO(CountersAreExact)
RUN_SCENARIO(CacheHoldsOneBrick)
RUN_SCENARIO(CacheHoldsTwoBricks)
RUN_SCENARIO(BlocksAreEvictedWhileTheyAreRead)
RUN_SCENARIO(FirstMissSendsLaterOnesJoin)
RUN_SCENARIO(StoresAndSegmentsCoexist)
RUN_SCENARIO(CancelWakesWaitingWorkers)
RUN_SCENARIO(LateRepliesOfACancelledFrameAreIgnored)
RUN_SCENARIO(CacheShrinksBetweenFrames)
RUN_SCENARIO(CacheSmallerThanOneBrickIsRefused)

} // namespace

#undef RUN_SCENARIO
