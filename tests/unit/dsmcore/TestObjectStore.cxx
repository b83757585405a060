// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/ObjectStore.h"

#include "DSMCore/memory/HostMemory.h"
#include "tests/unit/dsmcore/PairScenarios.h"

namespace
{

class ObjectStoreOnLoopback : public testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(Ranks, ObjectStoreOnLoopback, testing::Values(1, 3));

#define RUN_SCENARIO(scenario)                                                                     \
  TEST_P(ObjectStoreOnLoopback, scenario)                                                          \
  {                                                                                                \
    dsm_test::RunRanks(this->GetParam(), dsm_test::scenario);                                      \
  }

RUN_SCENARIO(EveryRankPublishesASlice)
RUN_SCENARIO(OneRankHasEverything)
RUN_SCENARIO(OneRankHasNoData)
RUN_SCENARIO(NoBlocksAtAll)
RUN_SCENARIO(LargeFragmentsFlow)
RUN_SCENARIO(HitsMissesAndEvictionsAreExact)
RUN_SCENARIO(CacheHoldsOneBrick)
RUN_SCENARIO(CacheHoldsTwoBricks)
RUN_SCENARIO(PairsShareACacheOfSixBricks)
RUN_SCENARIO(BlocksThatAreNotPairedAreNoPair)
RUN_SCENARIO(CacheSmallerThanTwoBricksIsRefusedToPairs)
RUN_SCENARIO(MissesAreQuiescentPoints)
RUN_SCENARIO(FirstMissSendsLaterOnesJoin)
RUN_SCENARIO(StoresShareAMessenger)
RUN_SCENARIO(FailingPublishFailsEverywhereAndTheNextWorks)
RUN_SCENARIO(RanksThatDisagreeAboutTheBlocksAreTold)
RUN_SCENARIO(CacheSmallerThanOneBrickIsRefused)
RUN_SCENARIO(CancelWakesWaitingWorkers)
RUN_SCENARIO(LateRepliesOfACancelledFrameAreIgnored)
RUN_SCENARIO(CacheShrinksBetweenFrames)

TEST(ObjectStoreStress, FourRanksTimesTwoWorkersThroughACacheOfThreeBlocks)
{
  dsm_test::RunRanks(4,
    [](dsm::Messenger& messenger)
    { dsm_test::RandomAccessThroughASmallCache(messenger, 2, 12500); });
}

TEST(ObjectStoreStress, TwoRanksTimesEightWorkersAMillionAccesses)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    { dsm_test::RandomAccessThroughASmallCache(messenger, 8, 62500); });
}

TEST(ObjectStore, NoWorkersAreRefused)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    {
      EXPECT_THROW(dsm::ObjectStore(messenger, dsm_test::MakeSettings(1000, 0)), dsm::Error);
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1000, 1));
      EXPECT_THROW(store.SetSettings(dsm_test::MakeSettings(1000, -2)), dsm::Error);
      EXPECT_EQ(store.GetSettings().Workers, 1);
    });
}

TEST(ObjectStore, MoreMemoryThanThereIsIsAnErrorOfThePublication)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1000, 1));
      // 2^17 blocks of 2^32 bytes a rank: more than an address space has.
      const dsm::BlockDirectory directory(std::vector<std::uint32_t>(std::size_t(1) << 18, ~0u),
        dsm::RoundRobinAssigner(messenger.GetSize()));
      dsm_test::PatternSource source(
        dsm_test::MakeDirectory(2, 0, 0), 0, 2, dsm_test::Spread::EveryRankASlice, 100);
      dsm_test::PatternSink sink;
      const std::string text =
        dsm_test::GetErrorText([&] { store.Publish("Loading", directory, source, sink); });
      // The ranks name what each of them found left, which may differ.
      EXPECT_EQ(text.find("Loading: "), 0u) << text;
      EXPECT_NE(text.find("out of memory: "), std::string::npos) << text;
    });
}

/// The system would grant the memory and end the process later.
TEST(ObjectStore, MoreMemoryThanTheHostHasLeftIsAnErrorOfThePublication)
{
  // Together three quarters more than there is.
  const std::uint64_t blocks = (dsm::GetAvailableHostMemory() / 4 * 7) >> 28;
  dsm_test::RunRanks(2,
    [&](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1000, 1));
      const dsm::BlockDirectory directory(
        std::vector<std::uint32_t>(blocks, 1u << 28), dsm::RoundRobinAssigner(2));
      dsm_test::PatternSource source(
        dsm_test::MakeDirectory(2, 0, 0), 0, 2, dsm_test::Spread::EveryRankASlice, 100);
      dsm_test::PatternSink sink;
      const std::string text =
        dsm_test::GetErrorText([&] { store.Publish("Loading", directory, source, sink); });
      // The ranks name what each of them found left, which may differ.
      EXPECT_EQ(text.find("Loading: "), 0u) << text;
      EXPECT_NE(text.find("out of memory: "), std::string::npos) << text;
      EXPECT_TRUE(sink.Begun.empty());
    });
}

TEST(ObjectStore, OwnersThatDoNotExistAreRefused)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1 << 16, 1));
      const auto directory = dsm_test::MakeDirectory(3, 4, 100);
      dsm_test::PatternSource source(
        directory, messenger.GetRank(), 2, dsm_test::Spread::EveryRankASlice, 100);
      dsm_test::PatternSink sink;
      const std::string text =
        dsm_test::GetErrorText([&] { store.Publish("Loading", directory, source, sink); });
      EXPECT_NE(text.find("Block 2 was assigned to rank 2"), std::string::npos) << text;
    });
}

TEST(ObjectStore, WorkerThatHoldsABlockMayNotWaitForAnother)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1 << 16, 1));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 4, 100));
      const dsm::BlockId own = static_cast<dsm::BlockId>(messenger.GetRank());
      const std::string text = dsm_test::GetErrorText(
        [&]
        {
          dsm_test::RunFrame(messenger, store,
            [&](dsm::ObjectStore::Worker& worker, int)
            {
              const auto first = store.Acquire(worker, *segment, own);
              const auto hit = store.Acquire(worker, *segment, own + 2); // no need to wait
              EXPECT_NE(first.GetData(), hit.GetData());
              store.Acquire(worker, *segment, 1 - own);
            });
        });
      EXPECT_NE(text.find("while it held another"), std::string::npos) << text;
    });
}

TEST(ObjectStore, WorkerMustEnterBeforeItMisses)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1 << 16, 1));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 2, 100));
      store.BeginFrame();
      EXPECT_THROW(store.Acquire(store.GetWorker(0), *segment,
                     static_cast<dsm::BlockId>(1 - messenger.GetRank())),
        dsm::Error);
      store.EndFrame();
      messenger.Barrier();
    });
}

TEST(ObjectStore, RemoteBlocksOutsideOfAFrameAndOfRetiredSegmentsAreErrors)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1 << 16, 1));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 2, 100));
      const dsm::BlockId own = static_cast<dsm::BlockId>(messenger.GetRank());
      dsm::ObjectStore::Worker& worker = store.GetWorker(0);
      store.Enter(worker);
      EXPECT_EQ(dsm_test::Visit(store, worker, *segment, own), 0u);
      EXPECT_THROW(store.Acquire(worker, *segment, 1 - own), dsm::Error);
      store.Leave(worker);
      store.Retire(segment);
      store.Retire(segment); // nothing left to do
      store.BeginFrame();
      store.Enter(worker);
      EXPECT_THROW(store.Acquire(worker, *segment, 1 - own), dsm::Error);
      store.Leave(worker);
      store.EndFrame();
      messenger.Barrier();
    });
}

TEST(ObjectStore, WithinAFrameNothingIsRearranged)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1 << 16, 1));
      const auto directory = dsm_test::MakeDirectory(1, 2, 100);
      const auto segment = dsm_test::PublishPattern(messenger, store, directory);
      store.BeginFrame();
      EXPECT_THROW(store.SetSettings(dsm_test::MakeSettings(1000, 1)), dsm::Error);
      EXPECT_THROW(store.Retire(segment), dsm::Error);
      EXPECT_THROW(store.BeginFrame(), dsm::Error);
      EXPECT_THROW(dsm_test::PublishPattern(messenger, store, directory), dsm::Error);
      store.EndFrame();
      store.EndFrame(); // nothing left to do
      store.Retire(segment);
    });
}

/// What rank 1 of 2 sends to a rank that has a frame open.
struct Request
{
  std::uint32_t Segment;
  std::uint32_t Frame;
  dsm::BlockId Id;
};

class MalformedMessage : public testing::Test
{
protected:
  /// Rank 1 sends what `make` yields; rank 0's frame must fail for it, and with it the frame of all.
  static void ExpectRejected(dsm::MessageKind kind,
    const std::function<std::vector<std::byte>(const dsm::BlockSegment&, std::uint32_t)>& make)
  {
    dsm_test::RunRanks(2,
      [&](dsm::Messenger& messenger)
      {
        dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1 << 16, 1));
        const auto segment =
          dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 4, 100));
        // BeginFrame takes one session for its agreement and one for the frame.
        const std::uint32_t frame = messenger.GetSession() + 2;
        const auto trace = [](dsm::ObjectStore::Worker&, int) {};
        const std::string text = dsm_test::GetErrorText(
          [&]
          {
            if (messenger.GetRank() == 1)
            {
              // From within the frame, but before this rank says that it is done.
              store.BeginFrame();
              EXPECT_EQ(messenger.GetSession(), frame);
              messenger.Post(0, kind, make(*segment, frame));
              messenger.Post(0, dsm::MessageKind::FrameDone, {});
              messenger.Post(1, dsm::MessageKind::FrameDone, {});
              int finished = 0;
              messenger.SetHandler(
                dsm::MessageKind::FrameDone, [&](dsm::Message&&) { ++finished; });
              messenger.ProgressUntil([&] { return finished == 2; });
              messenger.SetHandler(dsm::MessageKind::FrameDone, {});
              store.EndFrame();
              messenger.RunTogether("The frame failed", [] {});
            }
            else
            {
              dsm_test::RunFrame(messenger, store, trace);
            }
          });
        EXPECT_EQ(text.find("The frame failed: Rank 0: "), 0u) << text;
        EXPECT_NE(text.find("ank 1"), std::string::npos) << text;
        EXPECT_NE(text.find("same build"), std::string::npos) << text;
        dsm_test::RunFrame(messenger, store,
          [&](dsm::ObjectStore::Worker& worker, int)
          {
            EXPECT_EQ(dsm_test::Visit(store, worker, *segment, 0), 0u);
            EXPECT_EQ(dsm_test::Visit(store, worker, *segment, 1), 0u);
          });
      });
  }
};

TEST_F(MalformedMessage, RequestOfTheWrongSize)
{
  ExpectRejected(dsm::MessageKind::BlockRequest,
    [](const dsm::BlockSegment&, std::uint32_t) { return dsm::Encode(1); });
}

TEST_F(MalformedMessage, RequestForAnUnknownSegment)
{
  ExpectRejected(dsm::MessageKind::BlockRequest,
    [](const dsm::BlockSegment& segment, std::uint32_t frame) {
      return dsm::Encode(Request{ segment.GetNumber() + 77, frame, 0 });
    });
}

TEST_F(MalformedMessage, RequestForABlockOutOfRange)
{
  ExpectRejected(dsm::MessageKind::BlockRequest,
    [](const dsm::BlockSegment& segment, std::uint32_t frame) {
      return dsm::Encode(Request{ segment.GetNumber(), frame, 4 });
    });
}

TEST_F(MalformedMessage, RequestForABlockOfAnother)
{
  ExpectRejected(dsm::MessageKind::BlockRequest,
    [](const dsm::BlockSegment& segment, std::uint32_t frame) {
      return dsm::Encode(Request{ segment.GetNumber(), frame, 1 });
    });
}

TEST_F(MalformedMessage, ReplyThatNobodyAskedFor)
{
  ExpectRejected(dsm::MessageKind::BlockReply,
    [](const dsm::BlockSegment& segment, std::uint32_t frame)
    {
      std::vector<std::byte> bytes(100);
      dsm::AttachTail(bytes, Request{ segment.GetNumber(), frame, 1 });
      return bytes;
    });
}

TEST_F(MalformedMessage, ReplyWithoutAName)
{
  ExpectRejected(dsm::MessageKind::BlockReply,
    [](const dsm::BlockSegment&, std::uint32_t) { return dsm::Encode('x'); });
}

/// Left over from a frame that was cancelled: its segment may be gone, its answer is not wanted.
TEST(ObjectStore, MessagesOfAnOlderFrameAreIgnored)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::ObjectStore store(messenger, dsm_test::MakeSettings(1 << 16, 1));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 4, 100));
      const auto nothing = [](dsm::ObjectStore::Worker&, int) {};
      dsm_test::RunFrame(messenger, store, nothing);
      const std::uint32_t older = messenger.GetSession() - 1;
      const int other = 1 - messenger.GetRank();
      dsm_test::RunFrame(
        messenger, store,
        [&](dsm::ObjectStore::Worker& worker, int)
        {
          // Wrong bytes, which must not be taken for the block's.
          EXPECT_EQ(dsm_test::Visit(store, worker, *segment, static_cast<dsm::BlockId>(other)), 0u);
        },
        [&]
        {
          messenger.Post(other, dsm::MessageKind::BlockRequest,
            dsm::Encode(Request{ segment->GetNumber() + 77, older, 9 }));
          std::vector<std::byte> wrong(100);
          dsm::AttachTail(wrong,
            Request{ segment->GetNumber(), older, static_cast<dsm::BlockId>(messenger.GetRank()) });
          messenger.Post(other, dsm::MessageKind::BlockReply, std::move(wrong));
        });
      EXPECT_EQ(store.GetCounters().BytesReceived, 100u);
      EXPECT_EQ(store.GetCounters().BytesSent, 100u);
    });
}

} // namespace

#undef RUN_SCENARIO
