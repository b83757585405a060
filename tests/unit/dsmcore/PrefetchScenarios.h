// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_PrefetchScenarios_h
#define dsm_test_PrefetchScenarios_h

#include "DSMCore/paged/PagedStore.h"

#include "tests/unit/dsmcore/StoreTestTools.h"

#include <cstdint>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <vector>

/// What both stores that fetch must do with blocks that are asked for ahead of need, on any transport
/// and with two ranks or more; each is run by every rank. A block is a page, which is what it takes in
/// either store.
namespace dsm_test
{

template <class Store>
class PrefetchScenarios
{
public:
  using Worker = typename Store::Worker;

  static void AbsentBlocksComeInOneMessage(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 64);
    const auto ids = blocks.GetOwnedBy(blocks.Next, 8);
    RunFrame<Store>(messenger, *blocks.Memory,
      [&](Worker& worker, int)
      {
        blocks.Await(worker, ids);
        EXPECT_EQ(blocks.CountWrong(worker, ids), 0u);
      });
    const auto counters = blocks.Memory->GetCounters();
    EXPECT_EQ(counters.Workers.Misses, 0u);
    EXPECT_EQ(counters.Workers.Hits, 8u);
    EXPECT_EQ(counters.Prefetches, 8u);
    EXPECT_EQ(counters.PrefetchesUsed, 8u);
    EXPECT_EQ(counters.Requests, 1u);
    EXPECT_EQ(counters.BytesReceived, 8 * blocks.Bytes);
  }

  static void PresentPendingAndUnknownBlocksArePassedBy(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 64);
    const auto own = blocks.GetOwnedBy(messenger.GetRank(), 8);
    const auto one = blocks.GetOwnedBy(blocks.Next, 1);
    RunFrame<Store>(messenger, *blocks.Memory,
      [&](Worker& worker, int)
      {
        EXPECT_FALSE(blocks.Prefetch(own));
        EXPECT_FALSE(blocks.Prefetch({ blocks.Count, blocks.Count + 77 }));
        EXPECT_FALSE(blocks.Prefetch({}));
        EXPECT_TRUE(blocks.Prefetch({ own[0], blocks.Count, one[0], one[0] }));
        blocks.Prefetch(one); // on its way, or here
        blocks.Await(worker, one);
        EXPECT_EQ(blocks.CountWrong(worker, one), 0u);
        EXPECT_FALSE(blocks.Prefetch(one));
      });
    const auto counters = blocks.Memory->GetCounters();
    EXPECT_EQ(counters.Prefetches, 1u);
    EXPECT_EQ(counters.PrefetchesUsed, 1u);
    EXPECT_EQ(counters.Workers.Misses, 0u);
  }

  static void RetiredSegmentsAndClosedFramesArePassedBy(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 64);
    const auto ids = blocks.GetOwnedBy(blocks.Next, 4);
    blocks.Prefetch(ids);
    blocks.Memory->Retire(blocks.Segment);
    RunFrame<Store>(messenger, *blocks.Memory, [&](Worker&, int) { blocks.Prefetch(ids); });
    blocks.Prefetch(ids);
    EXPECT_EQ(blocks.Memory->GetCounters().Prefetches, 0u);
    EXPECT_EQ(blocks.Memory->GetCounters().CachedBytes, 0u);
  }

  static void MissesJoinWhatIsOnItsWay(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 64, 3);
    const auto ids = blocks.GetOwnedBy(blocks.Next, 8);
    RunFrame<Store>(messenger, *blocks.Memory,
      [&](Worker& worker, int)
      {
        blocks.Prefetch(ids);
        EXPECT_EQ(blocks.CountWrong(worker, ids), 0u);
      });
    const auto counters = blocks.Memory->GetCounters();
    EXPECT_EQ(counters.Workers.Misses - counters.Workers.Joins + counters.Prefetches, 8u);
    EXPECT_EQ(counters.PrefetchesUsed, counters.Prefetches);
    EXPECT_EQ(counters.BytesReceived, 8 * blocks.Bytes);
  }

  /// A quarter of the cache is for what nobody has used: of one block, none.
  static void CacheHoldsOneBrick(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 1, 8);
    RunFrame<Store>(messenger, *blocks.Memory,
      [&](Worker& worker, int index)
      {
        std::minstd_rand random(static_cast<unsigned>(index + 10 * messenger.GetRank() + 1));
        for (int i = 0; i < 30; ++i)
        {
          const dsm::BlockId id = random() % blocks.Count;
          blocks.Prefetch({ id, random() % blocks.Count, random() % blocks.Count });
          EXPECT_EQ(blocks.CountWrong(worker, { id }), 0u);
          blocks.Memory->Quiesce(worker);
        }
      });
    const auto counters = blocks.Memory->GetCounters();
    EXPECT_EQ(counters.Prefetches, 0u);
    EXPECT_EQ(counters.Workers.Accesses, 8u * 30);
    EXPECT_LE(counters.PeakCachedBytes, blocks.Bytes);
  }

  static void MoreThanTheCacheHolds(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 8);
    const auto ids = blocks.GetOwnedBy(blocks.Next, 12);
    RunFrame<Store>(messenger, *blocks.Memory,
      [&](Worker& worker, int)
      {
        blocks.Prefetch(ids);
        blocks.Await(worker, { ids[0], ids[1] });
        for (int i = 0; i < 50; ++i) // nobody uses anything: there is no more room
        {
          EXPECT_TRUE(blocks.Prefetch(ids));
        }
        EXPECT_EQ(blocks.CountWrong(worker, { ids[0], ids[1] }), 0u);
        blocks.Prefetch({ ids[2], ids[3], ids[4] });
        blocks.Await(worker, { ids[2], ids[3] });
        EXPECT_EQ(blocks.CountWrong(worker, ids), 0u);
      });
    const auto counters = blocks.Memory->GetCounters();
    EXPECT_EQ(counters.Prefetches, 4u);
    EXPECT_EQ(counters.PrefetchesUsed, 4u);
    EXPECT_EQ(counters.Workers.Misses, 8u);
    EXPECT_LE(counters.PeakCachedBytes, 8 * blocks.Bytes);
  }

  /// What is evicted, or left over at the end of the frame, without having been used.
  static void WasteIsSeen(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 4);
    const auto ids = blocks.GetOwnedBy(blocks.Next, 12);
    RunFrame<Store>(messenger, *blocks.Memory,
      [&](Worker& worker, int)
      {
        blocks.Await(worker, { ids[0] });
        for (std::size_t i = 1; i < 11; ++i)
        {
          EXPECT_EQ(blocks.CountWrong(worker, { ids[i] }), 0u);
          blocks.Memory->Quiesce(worker);
        }
        blocks.Await(worker, { ids[11] });
      });
    EXPECT_EQ(blocks.Memory->GetCounters().Prefetches, 2u);
    EXPECT_EQ(blocks.Memory->GetCounters().PrefetchesUsed, 0u);
    RunFrame<Store>(messenger, *blocks.Memory,
      [&](Worker& worker, int) { EXPECT_EQ(blocks.CountWrong(worker, { ids[11] }), 0u); });
    const auto counters = blocks.Memory->GetCounters();
    EXPECT_EQ(counters.Workers.Misses, 0u) << "it stayed";
    EXPECT_EQ(counters.Prefetches, 0u);
    EXPECT_EQ(counters.PrefetchesUsed, 0u);
  }

  /// A frame that is broken off, as late as may be; the room comes back, and the next frame is as good as
  /// new.
  static void CancelledWhileUnderWay(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 8);
    const auto ids = blocks.GetOwnedBy(blocks.Next, 2);
    for (int round = 0; round < 20; ++round)
    {
      blocks.Memory->BeginFrame();
      EXPECT_TRUE(blocks.Prefetch(ids));
      for (int i = 0; i < round % 3; ++i)
      {
        blocks.Memory->Service(); // the request leaves, but no answer is taken
      }
      if (round % 2 == 0)
      {
        blocks.Memory->Cancel("cut short");
        blocks.Prefetch(ids); // to no effect
        EXPECT_TRUE(blocks.Memory->Drain());
      }
      blocks.Memory->EndFrame();
      EXPECT_EQ(blocks.Memory->GetCounters().CachedBytes, 0u);
      EXPECT_EQ(blocks.Memory->GetCounters().PrefetchesUsed, 0u);
      messenger.Barrier();
      RunFrame<Store>(messenger, *blocks.Memory,
        [&](Worker& worker, int)
        {
          for (dsm::BlockId id = 0; id < blocks.Count; ++id)
          {
            EXPECT_EQ(blocks.CountWrong(worker, { id }), 0u);
          }
        });
      EXPECT_LE(blocks.Memory->GetCounters().PeakCachedBytes, 8 * blocks.Bytes);
      blocks.Forget();
    }
  }

  /// Workers stop as soon as they have asked: the frame ends when what is under way has come.
  static void FramesEndWhileBlocksAreUnderWay(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 32, 2);
    for (int round = 0; round < 30; ++round)
    {
      RunFrame<Store>(messenger, *blocks.Memory,
        [&](Worker&, int index)
        { blocks.Prefetch(blocks.GetOwnedBy(blocks.Next, static_cast<std::size_t>(4 + index))); });
      const auto counters = blocks.Memory->GetCounters();
      EXPECT_EQ(counters.BytesReceived, counters.Prefetches * blocks.Bytes);
      EXPECT_EQ(counters.CachedBytes, counters.BytesReceived) << "nothing stays set aside";
      EXPECT_EQ(counters.PrefetchesUsed, 0u);
      EXPECT_EQ(counters.Workers.Misses, 0u);
      blocks.Forget();
    }
  }

  /// Several workers that foresee and read random blocks through a small cache; every byte.
  static void SeveralWorkersAtOnce(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 9, 6);
    for (int frame = 0; frame < 2; ++frame)
    {
      RunFrame<Store>(messenger, *blocks.Memory,
        [&](Worker& worker, int index)
        {
          std::minstd_rand random(
            static_cast<unsigned>(1 + frame + 10 * index + 100 * messenger.GetRank()));
          std::size_t wrong = 0;
          for (int i = 0; i < 400; ++i)
          {
            std::vector<dsm::BlockId> ids(1 + random() % 5);
            for (dsm::BlockId& id : ids)
            {
              id = random() % (blocks.Count + 2); // some that there are not
            }
            blocks.Prefetch(ids);
            for (const dsm::BlockId id : ids)
            {
              // Some that were not foreseen; some of those that were are left.
              const dsm::BlockId other = random() % blocks.Count;
              wrong += blocks.CountWrong(worker, { id < blocks.Count ? id : other });
              wrong += random() % 4 == 0 ? blocks.CountWrong(worker, { other }) : 0;
            }
            blocks.Memory->Quiesce(worker);
          }
          EXPECT_EQ(wrong, 0u);
        });
      const auto counters = blocks.Memory->GetCounters();
      EXPECT_LE(counters.PeakCachedBytes, 9 * blocks.Bytes);
      EXPECT_GT(counters.Prefetches, 0u);
      EXPECT_GT(counters.PrefetchesUsed, 0u);
      EXPECT_LE(counters.PrefetchesUsed, counters.Prefetches);
      EXPECT_EQ(counters.BytesReceived,
        (counters.Workers.Misses - counters.Workers.Joins + counters.Prefetches) * blocks.Bytes);
    }
  }

  /// One segment takes another's place, and then gets other contents: what was used comes in one message,
  /// before anybody waits for it, and what was here in vain does not come again.
  static void WhatWasUsedComesAgain(dsm::Messenger& messenger)
  {
    Blocks blocks(messenger, 64);
    const auto ids = blocks.GetOwnedBy(blocks.Next, 8);
    const std::vector<dsm::BlockId> used(ids.begin(), ids.begin() + 6);
    const auto run = [&](const std::vector<dsm::BlockId>& wanted)
    {
      RunFrame<Store>(messenger, *blocks.Memory,
        [&](Worker& worker, int)
        {
          blocks.Await(worker, wanted);
          EXPECT_EQ(blocks.CountWrong(worker, used), 0u);
        });
    };
    run(ids);
    blocks.Memory->Retire(blocks.Segment);
    blocks.Segment = PublishPattern(
      messenger, *blocks.Memory, MakeDirectory(blocks.Ranks, blocks.Count, blocks.Bytes));
    for (int round = 0; round < 2; ++round)
    {
      run({ used[3] });
      const auto counters = blocks.Memory->GetCounters();
      EXPECT_EQ(counters.Prefetches, used.size());
      EXPECT_EQ(counters.PrefetchesUsed, used.size());
      EXPECT_EQ(counters.Workers.Misses, counters.Workers.Joins);
      EXPECT_EQ(counters.BytesReceived, used.size() * blocks.Bytes);
      EXPECT_EQ(counters.Requests, 1u);
      blocks.Memory->Refresh("Changing", *blocks.Segment, std::vector<bool>(blocks.Count, true));
    }
    blocks.Memory->Retire(blocks.Segment);
    blocks.Segment = PublishPattern(
      messenger, *blocks.Memory, MakeDirectory(blocks.Ranks, blocks.Count - 1, blocks.Bytes));
    RunFrame<Store>(messenger, *blocks.Memory, [](Worker&, int) {});
    EXPECT_EQ(blocks.Memory->GetCounters().Prefetches, 0u) << "another volume";
  }

  static void SwitchedOff(dsm::Messenger& messenger)
  {
    const Blocks blocks(messenger, 64);
    EXPECT_TRUE(blocks.Memory->MayPrefetch());
    auto settings = blocks.Memory->GetSettings();
    settings.Prefetch = false;
    blocks.Memory->SetSettings(settings);
    EXPECT_FALSE(blocks.Memory->MayPrefetch());
    const auto ids = blocks.GetOwnedBy(blocks.Next, 4);
    RunFrame<Store>(messenger, *blocks.Memory,
      [&](Worker& worker, int)
      {
        blocks.Prefetch(ids);
        EXPECT_EQ(blocks.CountWrong(worker, ids), 0u);
      });
    EXPECT_EQ(blocks.Memory->GetCounters().Prefetches, 0u);
    EXPECT_EQ(blocks.Memory->GetCounters().Workers.Misses, 4u);
  }

private:
  /// Sixteen blocks for each rank, in a store whose cache holds some of them.
  struct Blocks
  {
    const std::uint32_t Bytes = static_cast<std::uint32_t>(dsm::AddressRange::GetPageBytes());
    const int Ranks;
    const int Next; ///< the rank behind this one
    const dsm::BlockId Count;
    std::unique_ptr<Store> Memory;
    std::shared_ptr<dsm::BlockSegment> Segment;

    Blocks(dsm::Messenger& messenger, std::size_t cached, int workers = 1)
      : Ranks(messenger.GetSize())
      , Next((messenger.GetRank() + 1) % messenger.GetSize())
      , Count(static_cast<dsm::BlockId>(16 * this->Ranks))
    {
      typename Store::Settings settings;
      settings.CacheBytes = cached * this->Bytes;
      settings.Workers = workers;
      this->Memory = std::make_unique<Store>(messenger, settings);
      this->Segment = PublishPattern(
        messenger, *this->Memory, MakeDirectory(this->Ranks, this->Count, this->Bytes));
    }

    std::vector<dsm::BlockId> GetOwnedBy(int rank, std::size_t count) const
    {
      std::vector<dsm::BlockId> ids;
      for (std::size_t i = 0; i < count; ++i)
      {
        ids.push_back(static_cast<dsm::BlockId>(rank + static_cast<int>(i) * this->Ranks));
      }
      return ids;
    }
    bool Prefetch(const std::vector<dsm::BlockId>& ids) const
    {
      return this->Memory->Prefetch(*this->Segment, ids.data(), ids.size());
    }
    /// Asks for blocks until they are here, with quiescent points, since room may have to be made.
    void Await(Worker& worker, const std::vector<dsm::BlockId>& ids) const
    {
      while (this->Prefetch(ids))
      {
        this->Memory->Quiesce(worker);
        std::this_thread::yield();
      }
    }
    std::size_t CountWrong(Worker& worker, const std::vector<dsm::BlockId>& ids) const
    {
      return std::accumulate(ids.begin(), ids.end(), std::size_t{ 0 },
        [&](std::size_t sum, dsm::BlockId id)
        { return sum + Visit(*this->Memory, worker, *this->Segment, id); });
    }
    /// Between frames: empties the cache.
    void Forget() const
    {
      auto settings = this->Memory->GetSettings();
      const std::size_t cacheBytes = std::exchange(settings.CacheBytes, 0);
      this->Memory->SetSettings(settings);
      settings.CacheBytes = cacheBytes;
      this->Memory->SetSettings(settings);
    }
  };
};

} // namespace dsm_test

#endif
