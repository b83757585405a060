// SPDX-License-Identifier: BSD-3-Clause
// What the page store refuses.
#include "DSMCore/paged/PagedStore.h"

#include "tests/unit/dsmcore/PagedScenarios.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

namespace
{

using dsm_test::Way;

void WaitFor(const std::atomic<bool>& condition)
{
  while (!condition)
  {
    std::this_thread::yield();
  }
}

TEST(PagedStore, NoWorkersAreRefused)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    {
      EXPECT_THROW(dsm::PagedStore(messenger, Way().GetSettings(1000, 0)), dsm::Error);
      dsm::PagedStore store(messenger, Way().GetSettings(1000, 1));
      EXPECT_THROW(store.SetSettings(Way().GetSettings(1000, -2)), dsm::Error);
      EXPECT_EQ(store.GetSettings().Workers, 1);
    });
}

TEST(PagedStore, WithinAFrameNothingIsRearranged)
{
  dsm_test::RunRanks(1,
    [](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, Way().GetSettings(1 << 16));
      const auto directory = dsm_test::MakeDirectory(1, 2, 100);
      const auto segment = dsm_test::PublishPattern(messenger, store, directory);
      store.BeginFrame();
      EXPECT_THROW(store.SetSettings(Way().GetSettings(1000)), dsm::Error);
      EXPECT_THROW(store.Retire(segment), dsm::Error);
      EXPECT_THROW(store.BeginFrame(), dsm::Error);
      EXPECT_THROW(dsm_test::PublishPattern(messenger, store, directory), dsm::Error);
      store.EndFrame();
      store.EndFrame(); // nothing left to do
      store.Retire(segment);
      store.Retire(segment);
    });
}

/// Else the room that it keeps may be what the worker that has the slot waits for, in a fault.
TEST(PagedStore, WhoWaitsForASlotKeepsNoRoom)
{
  dsm_test::RunRanks(2,
    [&](dsm::Messenger& messenger)
    {
      const auto slots = std::make_shared<dsm::WorkerSlots>();
      auto settings = Way().GetSettings(dsm_test::GetPage(), 2); // of the cache: one block
      settings.Slots = slots;
      dsm::PagedStore store(messenger, settings);
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 4, 100));
      std::atomic<bool> hasRead{ false };
      std::atomic<bool> asks{ false };
      slots->BeginFrame(1);
      dsm_test::RunFrame(messenger, store,
        [&](dsm::PagedStore::Worker& worker, int index)
        {
          if (messenger.GetRank() == 1)
          {
            return;
          }
          const dsm::BlockId id = index == 0 ? 1 : 3; // of the other rank
          if (index == 1)
          {
            WaitFor(hasRead);
            const dsm::WorkerSlots::Hold slot(*slots);
            asks = true;
            EXPECT_EQ(dsm_test::Visit(store, worker, *segment, id), 0u);
            return;
          }
          slots->Take();
          const auto pin = store.Acquire(worker, *segment, id);
          EXPECT_EQ(dsm_test::CountWrongBytes(id, pin.GetData(), pin.GetBytes()), 0u);
          slots->Give();
          hasRead = true;
          WaitFor(asks);
          const dsm::WorkerSlots::Hold slot(*slots); // from the other worker, which waits
          std::this_thread::sleep_for(std::chrono::milliseconds(50)); // its block comes
          EXPECT_EQ(dsm_test::CountWrongBytes(id, pin.GetData(), pin.GetBytes()), 0u);
        });
      EXPECT_GE(store.GetCounters().Evictions, messenger.GetRank() == 0 ? 2u : 0u);
    });
}

TEST(PagedStore, PureFaultingIsChosenFromFrameToFrame)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      Way way;
      dsm::PagedStore store(messenger, way.GetSettings(2 * dsm_test::GetPage()));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 12, 100));
      for (int frame = 0; frame < 6; ++frame)
      {
        way.PureFaulting = frame % 2 == 1;
        store.SetSettings(way.GetSettings(2 * dsm_test::GetPage()));
        dsm_test::RunFrame(messenger, store,
          [&](dsm::PagedStore::Worker& worker, int)
          {
            for (dsm::BlockId id = 0; id < 12; ++id)
            {
              EXPECT_EQ(dsm_test::Visit(store, worker, *segment, id), 0u);
            }
          });
        EXPECT_EQ(store.GetCounters().Workers.Misses, 6u);
      }
    });
}

TEST(PagedStore, RemoteBlocksOutsideOfAFrameAndOfRetiredSegmentsAreErrors)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, Way().GetSettings(1 << 16));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 2, 100));
      const dsm::BlockId own = static_cast<dsm::BlockId>(messenger.GetRank());
      dsm::PagedStore::Worker& worker = store.GetWorker(0);
      store.Enter(worker);
      EXPECT_EQ(dsm_test::Visit(store, worker, *segment, own), 0u);
      EXPECT_THROW(store.Acquire(worker, *segment, 1 - own), dsm::Error);
      store.Leave(worker);
      store.Retire(segment);
      store.BeginFrame();
      store.Enter(worker);
      EXPECT_EQ(dsm_test::Visit(store, worker, *segment, own), 0u);
      EXPECT_THROW(store.Acquire(worker, *segment, 1 - own), dsm::Error);
      store.Leave(worker);
      store.EndFrame();
      messenger.Barrier();
    });
}

TEST(PagedStore, OnlyWorkersThatEnteredMayWait)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, Way().GetSettings(1 << 16));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 2, 100));
      const dsm::BlockId remote = static_cast<dsm::BlockId>(1 - messenger.GetRank());
      dsm::PagedStore::Worker& worker = store.GetWorker(0);
      store.BeginFrame();
      EXPECT_NE(dsm_test::GetErrorText([&] { store.Acquire(worker, *segment, remote); })
                  .find("before it entered"),
        std::string::npos);
      store.Enter(worker);
      EXPECT_NE(dsm_test::GetErrorText([&] { store.Acquire(worker, *segment, remote); })
                  .find("communication thread"),
        std::string::npos);
      store.Leave(worker);
      store.EndFrame();
      messenger.Barrier();
    });
}

TEST(PagedStore, SegmentOutlivesItsStore)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      auto store = std::make_unique<dsm::PagedStore>(messenger, Way().GetSettings(1 << 16));
      const auto segment =
        dsm_test::PublishPattern(messenger, *store, dsm_test::MakeDirectory(2, 6, 100));
      store.reset();
      int residents = 0;
      segment->ForEachResident(
        [&](dsm::BlockId id, const std::byte* block, std::size_t bytes)
        {
          ++residents;
          EXPECT_EQ(dsm_test::CountWrongBytes(id, block, bytes), 0u);
        });
      EXPECT_EQ(residents, 3) << "each rank has its half";
    });
}

TEST(PagedStore, WorkerThatFailsIsTheFramesErrorAndTheNextFrameWorks)
{
  dsm_test::RunRanks(2,
    [](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, Way().GetSettings(1 << 16));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 6, 100));
      for (int frame = 0; frame < 2; ++frame)
      {
        const auto trace = [&](dsm::PagedStore::Worker& worker, int)
        {
          EXPECT_EQ(dsm_test::Visit(store, worker, *segment, 0), 0u);
          EXPECT_EQ(dsm_test::Visit(store, worker, *segment, 1), 0u);
          if (frame == 0 && messenger.GetRank() == 1)
          {
            throw dsm::Error("a worker stumbled");
          }
        };
        if (frame == 0)
        {
          EXPECT_EQ(dsm_test::GetErrorText([&] { dsm_test::RunFrame(messenger, store, trace); }),
            "The frame failed: Rank 1: a worker stumbled");
        }
        else
        {
          dsm_test::RunFrame(messenger, store, trace);
        }
      }
    });
}

/// What rank 1 of 2 sends to a rank that has a frame open; on the wire as the store has it.
struct Name
{
  std::uint32_t Segment;
  std::uint32_t Frame;
  dsm::BlockId Id;
};

void ExpectRejected(dsm::MessageKind kind,
  const std::function<std::vector<std::byte>(const dsm::BlockSegment&, std::uint32_t)>& make)
{
  dsm_test::RunRanks(2,
    [&](dsm::Messenger& messenger)
    {
      dsm::PagedStore store(messenger, Way().GetSettings(1 << 16));
      const auto segment =
        dsm_test::PublishPattern(messenger, store, dsm_test::MakeDirectory(2, 4, 100));
      const auto look = [&](dsm::PagedStore::Worker& worker, int)
      {
        EXPECT_EQ(dsm_test::Visit(store, worker, *segment, 0), 0u);
        EXPECT_EQ(dsm_test::Visit(store, worker, *segment, 1), 0u);
      };
      const std::string text = dsm_test::GetErrorText(
        [&]
        {
          dsm_test::RunFrame(
            messenger, store, [](dsm::PagedStore::Worker&, int) {},
            [&]
            {
              if (messenger.GetRank() == 1)
              {
                messenger.Post(0, kind, make(*segment, messenger.GetSession()));
              }
            });
        });
      EXPECT_EQ(text.find("The frame failed: Rank 0: "), 0u) << text;
      EXPECT_NE(text.find("same build"), std::string::npos) << text;
      dsm_test::RunFrame(messenger, store, look);
    });
}

TEST(PagedStoreMessages, RequestOfTheWrongSize)
{
  ExpectRejected(dsm::MessageKind::BlockRequest,
    [](const dsm::BlockSegment&, std::uint32_t) { return dsm::Encode(1); });
}

TEST(PagedStoreMessages, RequestForABlockOutOfRange)
{
  ExpectRejected(dsm::MessageKind::BlockRequest,
    [](const dsm::BlockSegment& segment, std::uint32_t frame) {
      return dsm::Encode(Name{ segment.GetNumber(), frame, 4 });
    });
}

TEST(PagedStoreMessages, RequestForABlockOfAnother)
{
  ExpectRejected(dsm::MessageKind::BlockRequest,
    [](const dsm::BlockSegment& segment, std::uint32_t frame) {
      return dsm::Encode(Name{ segment.GetNumber(), frame, 1 });
    });
}

TEST(PagedStoreMessages, ReplyThatNobodyAskedFor)
{
  ExpectRejected(dsm::MessageKind::BlockReply,
    [](const dsm::BlockSegment& segment, std::uint32_t frame)
    {
      std::vector<std::byte> bytes(100);
      dsm::AttachTail(bytes, Name{ segment.GetNumber(), frame, 1 });
      return bytes;
    });
}

TEST(PagedStoreMessages, ReplyWithoutAName)
{
  ExpectRejected(dsm::MessageKind::BlockReply,
    [](const dsm::BlockSegment&, std::uint32_t) { return dsm::Encode('x'); });
}

} // namespace
