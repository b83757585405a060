// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/ReplicatedStore.h"

#include "tests/unit/dsmcore/PrefetchScenarios.h"

namespace
{

template <class Store>
class Prefetch : public testing::Test
{
};

using Stores = testing::Types<dsm::ObjectStore, dsm::PagedStore>;
TYPED_TEST_SUITE(Prefetch, Stores);

#define RUN_SCENARIO(scenario)                                                                     \
  TYPED_TEST(Prefetch, scenario)                                                                   \
  {                                                                                                \
    for (const int ranks : { 2, 3 })                                                               \
    {                                                                                              \
      dsm_test::RunRanks(ranks, dsm_test::PrefetchScenarios<TypeParam>::scenario);                 \
    }                                                                                              \
  }

RUN_SCENARIO(AbsentBlocksComeInOneMessage)
RUN_SCENARIO(PresentPendingAndUnknownBlocksArePassedBy)
RUN_SCENARIO(RetiredSegmentsAndClosedFramesArePassedBy)
RUN_SCENARIO(MissesJoinWhatIsOnItsWay)
RUN_SCENARIO(CacheHoldsOneBrick)
RUN_SCENARIO(MoreThanTheCacheHolds)
RUN_SCENARIO(WasteIsSeen)
RUN_SCENARIO(CancelledWhileUnderWay)
RUN_SCENARIO(FramesEndWhileBlocksAreUnderWay)
RUN_SCENARIO(SeveralWorkersAtOnce)
RUN_SCENARIO(WhatWasUsedComesAgain)
RUN_SCENARIO(SwitchedOff)

} // namespace

TEST(PrefetchWhereAllIsHere, DoesNothing)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm::ObjectStore::Settings{});
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(1, 4, 100));
      EXPECT_FALSE(store.MayPrefetch());
      const dsm::BlockId ids[] = { 0, 1, 2, 3 };
      dsm_test::RunFrame<dsm::ObjectStore>(messenger, store,
        [&](dsm::ObjectStore::Worker&, int) { EXPECT_FALSE(store.Prefetch(*segment, ids, 4)); });
    });
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ReplicatedStore store(messenger, dsm::ReplicatedStore::Settings{});
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 4, 100));
      EXPECT_FALSE(store.MayPrefetch());
      const dsm::BlockId ids[] = { 0, 1, 2, 3 };
      EXPECT_FALSE(store.Prefetch(*segment, ids, 4));
    });
}

#undef RUN_SCENARIO
