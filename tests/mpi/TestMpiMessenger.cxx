// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/Messenger.h"
#include "DSMCore/transport/MpiTransport.h"

#include "tests/unit/dsmcore/MessengerScenarios.h"

namespace
{

#define RUN_SCENARIO(scenario)                                                                     \
  TEST(MessengerOverMpi, scenario)                                                                 \
  {                                                                                                \
    dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));                                  \
    dsm_test::scenario(messenger);                                                                 \
  }

RUN_SCENARIO(AllGatherKeepsRankOrderAndSizes)
RUN_SCENARIO(AllGatherValueKeepsRankOrder)
RUN_SCENARIO(BroadcastReachesAll)
RUN_SCENARIO(ReduceCombinesTheValuesOfAllRanks)
RUN_SCENARIO(CollectivesInARowDoNotMix)
RUN_SCENARIO(NobodyLeavesABarrierBeforeTheLastEnters)
RUN_SCENARIO(AgreeNamesTheLowestFailingRank)
RUN_SCENARIO(RunTogetherThrowsTheSameOnEveryRank)
RUN_SCENARIO(EarlyMessagesWaitForTheirSession)
RUN_SCENARIO(MessagesOfTheSessionWaitForTheirHandler)
RUN_SCENARIO(MessagesOfAnEarlierSessionReachAHandler)
RUN_SCENARIO(MessagesOfAnEarlierSessionWithoutHandlerAreDropped)
RUN_SCENARIO(MessagesOfAPairKeepTheirOrder)
RUN_SCENARIO(HandlerThatThrowsDoesNotBreakACollective)

/// A rank that leaves a collective and computes for long must not keep the others in it.
TEST(MessengerOverMpi, CollectiveEndsForAllThoughRankZeroIsAway)
{
  using Clock = std::chrono::steady_clock;
  dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));
  messenger.Barrier();
  const auto start = Clock::now();
  const auto bytes = messenger.Broadcast(dsm_test::MakeBytes(std::size_t(8) << 20, 1));
  const auto spent = Clock::now() - start;
  if (messenger.GetRank() == 0)
  {
    std::this_thread::sleep_for(std::chrono::seconds(2));
  }
  else
  {
    EXPECT_LT(spent, std::chrono::milliseconds(1500));
  }
  EXPECT_EQ(bytes.size(), std::size_t(8) << 20);
  messenger.Barrier();
}

TEST(MessengerOverMpi, AllRanksAreOnThisHost)
{
  dsm::Messenger messenger(dsm::MpiTransport::Create(nullptr));
  EXPECT_EQ(messenger.GetRanksOnHost(), messenger.GetSize());
}

} // namespace

#undef RUN_SCENARIO
