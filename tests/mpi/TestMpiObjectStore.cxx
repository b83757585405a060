// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/ObjectStore.h"
#include "DSMCore/transport/MpiTransport.h"

#include "tests/unit/dsmcore/StoreScenarios.h"

namespace
{

#define RUN_SCENARIO(scenario)                                                                     \
  TEST(ObjectStoreOverMpi, scenario)                                                               \
  {                                                                                                \
    dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));                                  \
    dsm_test::scenario(messenger);                                                                 \
  }

RUN_SCENARIO(EveryRankPublishesASlice)
RUN_SCENARIO(OneRankHasEverything)
RUN_SCENARIO(OneRankHasNoData)
RUN_SCENARIO(NoBlocksAtAll)
RUN_SCENARIO(LargeFragmentsFlow)
RUN_SCENARIO(HitsMissesAndEvictionsAreExact)
RUN_SCENARIO(CacheHoldsOneBrick)
RUN_SCENARIO(MissesAreQuiescentPoints)
RUN_SCENARIO(FirstMissSendsLaterOnesJoin)
RUN_SCENARIO(StoresShareAMessenger)
RUN_SCENARIO(FailingPublishFailsEverywhereAndTheNextWorks)
RUN_SCENARIO(RanksThatDisagreeAboutTheBlocksAreTold)
RUN_SCENARIO(CacheSmallerThanOneBrickIsRefused)
RUN_SCENARIO(CancelWakesWaitingWorkers)
RUN_SCENARIO(LateRepliesOfACancelledFrameAreIgnored)
RUN_SCENARIO(CacheShrinksBetweenFrames)

TEST(ObjectStoreOverMpi, TwoWorkersARankThroughACacheOfThreeBlocks)
{
  dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));
  dsm_test::RandomAccessThroughASmallCache(messenger, 2, 4000);
}

} // namespace

#undef RUN_SCENARIO
