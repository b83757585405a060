// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/PagedStore.h"
#include "DSMCore/transport/MpiTransport.h"

#include "tests/unit/dsmcore/PagedScenarios.h"

namespace
{

class PagedStoreOverMpi : public testing::TestWithParam<dsm_test::Way>
{
protected:
  void Run(const std::function<void(dsm::Messenger&, const dsm_test::Way&)>& scenario)
  {
    dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));
    const std::string refusal = this->GetParam().GetRefusal();
    const dsm::Status status = messenger.Agree(refusal); // all or none
    if (!status.IsOk())
    {
      GTEST_SKIP() << status.Cause;
    }
    scenario(messenger, this->GetParam());
  }
};

INSTANTIATE_TEST_SUITE_P(Ways, PagedStoreOverMpi, testing::ValuesIn(dsm_test::GetAllWays()),
  [](const testing::TestParamInfo<dsm_test::Way>& way) { return way.param.GetName(); });

#define RUN_SCENARIO(scenario)                                                                     \
  TEST_P(PagedStoreOverMpi, scenario)                                                              \
  {                                                                                                \
    this->Run(dsm_test::Paged##scenario);                                                          \
  }

RUN_SCENARIO(EveryByteArrives)
RUN_SCENARIO(NoBlocksAtAll)
RUN_SCENARIO(CountersAreExact)
RUN_SCENARIO(CacheHoldsOneBrick)
RUN_SCENARIO(BlocksAreEvictedWhileTheyAreRead)
RUN_SCENARIO(FirstMissSendsLaterOnesJoin)
RUN_SCENARIO(StoresAndSegmentsCoexist)
RUN_SCENARIO(CancelWakesWaitingWorkers)
RUN_SCENARIO(LateRepliesOfACancelledFrameAreIgnored)
RUN_SCENARIO(CacheShrinksBetweenFrames)
RUN_SCENARIO(CacheSmallerThanOneBrickIsRefused)

TEST_P(PagedStoreOverMpi, TwoWorkersARankThroughACacheOfThreeBlocks)
{
  this->Run([](dsm::Messenger& messenger, const dsm_test::Way& way)
    { dsm_test::PagedRandomAccess(messenger, way, 2, 4000); });
}

} // namespace

#undef RUN_SCENARIO
