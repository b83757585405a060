// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/Messenger.h"

#include "tests/unit/dsmcore/MessengerScenarios.h"

#include <atomic>

namespace
{

class MessengerOnLoopback : public testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(Ranks, MessengerOnLoopback, testing::Values(1, 3, 7));

#define RUN_SCENARIO(scenario)                                                                     \
  TEST_P(MessengerOnLoopback, scenario)                                                            \
  {                                                                                                \
    dsm_test::RunRanks(this->GetParam(), dsm_test::scenario);                                      \
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

TEST_P(MessengerOnLoopback, AllRanksAreOnThisHost)
{
  dsm_test::RunRanks(this->GetParam(),
    [](dsm::Messenger& messenger)
    {
      EXPECT_EQ(messenger.GetRanksOnHost(), messenger.GetSize());
      EXPECT_EQ(messenger.GetRanksOnHost(), messenger.GetSize());
    });
}

TEST(Messenger, NeedsATransport)
{
  EXPECT_THROW(dsm::Messenger(nullptr), dsm::Error);
}

TEST(Messenger, CollectiveMessagesAreItsOwn)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    { EXPECT_THROW(messenger.SetHandler(dsm::MessageKind::Collective, {}), dsm::Error); });
}

TEST(Messenger, UnknownKindIsRejected)
{
  auto transports = dsm::LoopbackTransport::CreateGroup(2);
  dsm::Message message;
  message.Kind = static_cast<dsm::MessageKind>(99);
  transports[0]->Post(1, std::move(message));
  dsm::Messenger receiver(std::move(transports[1]));
  const std::string text = dsm_test::GetErrorText([&] { receiver.Progress(); });
  EXPECT_NE(text.find("99"), std::string::npos) << text;
  EXPECT_THROW(receiver.Post(0, static_cast<dsm::MessageKind>(0), {}), dsm::Error);
}

TEST(Messenger, ThrowingHandlerKeepsTheMessagesBehind)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    {
      std::vector<int> seen;
      messenger.SetHandler(dsm::MessageKind::TileGrant,
        [&](dsm::Message&& message)
        {
          seen.push_back(dsm::Decode<int>(message, dsm::MessageKind::TileGrant));
          if (seen.back() == 1)
          {
            throw dsm::Error("one");
          }
        });
      for (int i = 0; i < 4; ++i)
      {
        messenger.Post(0, dsm::MessageKind::TileGrant, dsm::Encode(i));
      }
      EXPECT_EQ(dsm_test::GetErrorText([&] { messenger.Progress(); }), "one");
      EXPECT_EQ(seen, std::vector<int>({ 0, 1 }));
      messenger.Progress();
      EXPECT_EQ(seen, std::vector<int>({ 0, 1, 2, 3 }));
    });
}

TEST(Messenger, HandlerMustNotWait)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    {
      messenger.SetHandler(
        dsm::MessageKind::TileGrant, [&](dsm::Message&&) { messenger.Progress(); });
      messenger.Post(0, dsm::MessageKind::TileGrant, {});
      EXPECT_THROW(messenger.Progress(), dsm::Error);
    });
}

TEST(Messenger, WakeUpIsNeverLost)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    {
      std::atomic<int> asked{ 0 };
      std::atomic<int> answered{ 0 };
      const int rounds = 2000;
      std::thread worker(
        [&]
        {
          for (int i = 1; i <= rounds; ++i)
          {
            asked = i;
            messenger.WakeUp();
            while (answered < i)
            {
              std::this_thread::yield();
            }
          }
        });
      messenger.ProgressUntil([&] { return answered == rounds; },
        [&]
        {
          const bool any = answered != asked;
          answered = asked.load();
          return any;
        });
      worker.join();
      EXPECT_EQ(answered, rounds);
    });
}

TEST(Messenger, WaitingRankLeavesTheProcessorToOthers)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    {
      const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(200);
      std::size_t polls = 0;
      messenger.ProgressUntil(
        [&]
        {
          ++polls;
          return std::chrono::steady_clock::now() >= end;
        });
      // Sleeps of 200 us: about a thousand; a rank that spins makes millions.
      EXPECT_LT(polls, 20000u);
    });
}

} // namespace

#undef RUN_SCENARIO
