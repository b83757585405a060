// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_PagedScenarios_h
#define dsm_test_PagedScenarios_h

#include "DSMCore/paged/PageFaults.h"
#include "DSMCore/paged/PagedStore.h"

#include "tests/unit/dsmcore/PairScenarios.h"

#include <atomic>
#include <cstdint>
#include <random>
#include <string>
#include <thread>
#include <vector>

/// What the page store must do on any transport and number of ranks, asking first or not; each is run by
/// every rank.
namespace dsm_test
{

inline std::size_t GetPage()
{
  return dsm::AddressRange::GetPageBytes();
}

/// How a test's stores read blocks.
struct Way
{
  bool PureFaulting = false;

  dsm::PagedStore::Settings GetSettings(std::size_t cacheBytes, int workers = 1) const
  {
    return { cacheBytes, workers, this->PureFaulting };
  }

  /// Empty where the system allows it.
  static std::string GetRefusal()
  {
    try
    {
      const dsm::PageFaults faults;
    }
    catch (const dsm::Error& error)
    {
      return error.what();
    }
    return {};
  }

  std::string GetName() const { return this->PureFaulting ? "Pure" : "AsksFirst"; }
};

inline std::vector<Way> GetAllWays()
{
  return { { false }, { true } };
}

inline std::size_t RoundUp(std::size_t bytes)
{
  return dsm::AddressRange::RoundUpToPages(bytes);
}

inline void PagedEveryByteArrives(dsm::Messenger& messenger, const Way& way)
{
  const int size = messenger.GetSize();
  const std::uint32_t page = static_cast<std::uint32_t>(GetPage());
  for (const auto& bytes : { std::vector<std::uint32_t>{
                               0, 1, 63, page, page + 1, 2 * page - 1, 300001, 12, 5000, 0, 777 },
         std::vector<std::uint32_t>(23, 2 * page + 5), std::vector<std::uint32_t>(1, page) })
  {
    const dsm::BlockDirectory directory(bytes, dsm::RoundRobinAssigner(size));
    dsm::PagedStore store(messenger, way.GetSettings(std::size_t(1) << 20));
    const auto segment =
      PublishPattern(messenger, store, directory, Spread::EveryRankASlice, 40000);
    std::vector<dsm::BlockId> owned;
    segment->ForEachResident(
      [&](dsm::BlockId id, const std::byte* block, std::size_t count)
      {
        EXPECT_EQ(directory.GetOwner(id), messenger.GetRank());
        EXPECT_EQ(count, directory.GetBytes(id));
        EXPECT_EQ(CountWrongBytes(id, block, count), 0u);
        owned.push_back(id);
      });
    EXPECT_TRUE(std::is_sorted(owned.begin(), owned.end()));
    EXPECT_GE(segment->GetResidentBytes(), directory.GetResidentBytes(messenger.GetRank()));
    for (int frame = 0; frame < 2; ++frame)
    {
      RunFrame(messenger, store,
        [&](dsm::PagedStore::Worker& worker, int)
        {
          for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
          {
            EXPECT_EQ(Visit(store, worker, *segment, id), 0u) << "block " << id;
            const auto pin = store.Acquire(worker, *segment, id);
            EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pin.GetData()) % GetPage(), 0u);
            for (std::size_t tail = pin.GetBytes(); tail % GetPage() != 0; ++tail)
            {
              ASSERT_EQ(pin.GetData()[tail], std::byte{ 0 });
            }
          }
        });
    }
    EXPECT_EQ(store.GetCounters().Workers.Misses, 0u) << "the second frame finds all here";
    store.Retire(segment);
    EXPECT_EQ(store.GetCounters().CachedBytes, 0u);
    EXPECT_EQ(store.GetCounters().ResidentBytes, 0u);
    segment->ForEachResident([&](dsm::BlockId id, const std::byte* block, std::size_t count)
      { EXPECT_EQ(CountWrongBytes(id, block, count), 0u); });
  }
}

inline void PagedNoBlocksAtAll(dsm::Messenger& messenger, const Way& way)
{
  dsm::PagedStore store(messenger, way.GetSettings(0));
  const auto segment = PublishPattern(messenger, store, MakeDirectory(messenger.GetSize(), 0, 0));
  segment->ForEachResident(
    [](dsm::BlockId id, const std::byte*, std::size_t) { ADD_FAILURE() << "block " << id; });
  RunFrame(messenger, store, [](dsm::PagedStore::Worker&, int) {});
  EXPECT_EQ(store.GetCounters().ResidentBytes, 0u);
}

inline void PagedCountersAreExact(dsm::Messenger& messenger, const Way& way)
{
  const int size = messenger.GetSize();
  const std::uint64_t remote = 9 * static_cast<std::uint64_t>(size - 1); // of 9 blocks a rank
  const std::uint32_t bytes = 1024;
  const std::uint64_t page = GetPage();
  const auto directory = MakeDirectory(size, 9 * static_cast<std::size_t>(size), bytes);
  dsm::PagedStore store(messenger, way.GetSettings(4 * page));
  const auto segment = PublishPattern(messenger, store, directory);
  const std::uint64_t count = directory.GetCount();
  RunFrame(messenger, store,
    [&](dsm::PagedStore::Worker& worker, int)
    {
      for (dsm::BlockId id = 0; id < count; ++id)
      {
        EXPECT_EQ(Visit(store, worker, *segment, id), 0u);
        EXPECT_EQ(Visit(store, worker, *segment, id), 0u);
      }
    });
  const auto counters = store.GetCounters();
  EXPECT_EQ(counters.Workers.Accesses, 2 * count);
  EXPECT_EQ(counters.Workers.Misses, remote);
  EXPECT_EQ(counters.Workers.Hits, 2 * count - remote);
  EXPECT_EQ(counters.Workers.Joins, 0u);
  EXPECT_EQ(counters.BytesReceived, remote * bytes);
  EXPECT_EQ(counters.BytesSent, remote * bytes); // by symmetry
  EXPECT_EQ(counters.Evictions, remote > 4 ? remote - 4 : 0);
  EXPECT_EQ(counters.ResidentBytes, 9 * page);
  EXPECT_EQ(counters.CachedBytes, std::min<std::uint64_t>(remote, 4) * page);
  EXPECT_EQ(counters.PeakCachedBytes, counters.CachedBytes);
  EXPECT_EQ(counters.CacheCapacity, 4 * page);
  EXPECT_EQ(counters.Workers.WaitNanoseconds > 0, remote > 0);
  EXPECT_EQ(store.GetWorkerCounters().size(), 1u);
  EXPECT_EQ(store.GetWorkerCounters().front().Misses, remote);
}

/// A cache of one block and eight workers that want different ones must get on.
inline void PagedCacheHoldsOneBrick(dsm::Messenger& messenger, const Way& way)
{
  const std::uint32_t bytes = static_cast<std::uint32_t>(2 * GetPage());
  const int workers = 8;
  const auto directory =
    MakeDirectory(messenger.GetSize(), 4 * static_cast<std::size_t>(messenger.GetSize()), bytes);
  dsm::PagedStore store(messenger, way.GetSettings(bytes, workers));
  const auto segment = PublishPattern(messenger, store, directory);
  RunFrame(messenger, store,
    [&](dsm::PagedStore::Worker& worker, int index)
    {
      std::minstd_rand random(static_cast<unsigned>(index + 10 * messenger.GetRank() + 1));
      for (int i = 0; i < 30; ++i)
      {
        EXPECT_EQ(Visit(store, worker, *segment, random() % directory.GetCount()), 0u);
        store.Quiesce(worker);
      }
    });
  const auto counters = store.GetCounters();
  EXPECT_EQ(counters.Workers.Accesses, 30u * workers);
  EXPECT_LE(counters.PeakCachedBytes, bytes);
  // Every miss that did not join was answered by one block.
  EXPECT_EQ(counters.BytesReceived, (counters.Workers.Misses - counters.Workers.Joins) * bytes);
}

inline void PagedCacheHoldsTwoBricks(dsm::Messenger& messenger, const Way& way)
{
  dsm::PagedStore store(messenger, way.GetSettings(2 * GetPage(), 8));
  ReadRandomPairs(messenger, store, 512);
  EXPECT_LE(store.GetCounters().PeakCachedBytes, 2 * GetPage());
}

/// What a thread reads stays right although the block is evicted under its hands.
inline void PagedBlocksAreEvictedWhileTheyAreRead(dsm::Messenger& messenger, const Way& way)
{
  const int size = messenger.GetSize();
  const std::uint32_t bytes = static_cast<std::uint32_t>(GetPage());
  const auto directory = MakeDirectory(size, 8 * static_cast<std::size_t>(size), bytes);
  dsm::PagedStore store(messenger, way.GetSettings(bytes, 2));
  const auto segment = PublishPattern(messenger, store, directory);
  RunFrame(messenger, store,
    [&](dsm::PagedStore::Worker& worker, int index)
    {
      std::vector<std::pair<dsm::BlockId, const std::byte*>> blocks;
      for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
      {
        blocks.emplace_back(id, store.Acquire(worker, *segment, id).GetData());
      }
      // A byte of every block in turn, without asking: a cache of one serves that too.
      std::size_t wrong = 0;
      for (std::size_t place = static_cast<std::size_t>(index); place < bytes; place += 500)
      {
        for (const auto& [id, block] : blocks)
        {
          wrong += block[place] != GetPattern(id, place) ? 1 : 0;
        }
      }
      EXPECT_EQ(wrong, 0u);
    });
  EXPECT_LE(store.GetCounters().PeakCachedBytes, bytes);
  if (size > 1)
  {
    EXPECT_GT(store.GetCounters().Evictions, 8u);
  }
}

inline void PagedFirstMissSendsLaterOnesJoin(dsm::Messenger& messenger, const Way& way)
{
  const int workers = 4;
  const auto directory = MakeDirectory(messenger.GetSize(), 64, 2048);
  dsm::PagedStore store(messenger, way.GetSettings(std::size_t(1) << 20, workers));
  const auto segment = PublishPattern(messenger, store, directory);
  RunFrame(messenger, store,
    [&](dsm::PagedStore::Worker& worker, int)
    {
      for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
      {
        EXPECT_EQ(Visit(store, worker, *segment, id), 0u);
      }
    });
  // All four read all blocks, but each remote block was fetched once.
  const auto counters = store.GetCounters();
  std::uint64_t remote = 0;
  for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
  {
    remote += directory.GetOwner(id) != messenger.GetRank() ? 1 : 0;
  }
  EXPECT_EQ(counters.Workers.Misses - counters.Workers.Joins, remote);
  EXPECT_EQ(counters.BytesReceived, remote * 2048);
  EXPECT_EQ(counters.Evictions, 0u);
}

/// Several segments in several stores on one messenger, some retired, their blocks not confused.
inline void PagedStoresAndSegmentsCoexist(dsm::Messenger& messenger, const Way& way)
{
  const int size = messenger.GetSize();
  dsm::PagedStore first(messenger, way.GetSettings(8 * GetPage()));
  dsm::PagedStore second(messenger, way.GetSettings(8 * GetPage()));
  const auto small = MakeDirectory(size, 12, 100);
  const auto large = MakeDirectory(size, 20, 3 * static_cast<std::uint32_t>(GetPage()) - 7);
  const auto one = PublishPattern(messenger, first, small);
  const auto two = PublishPattern(messenger, second, large);
  auto three = PublishPattern(messenger, first, large);
  EXPECT_NE(one->GetNumber(), two->GetNumber());
  const auto numbers = messenger.AllGatherValue(three->GetNumber());
  EXPECT_EQ(numbers.front(), numbers.back());
  for (int frame = 0; frame < 6; ++frame)
  {
    const dsm::BlockId id = static_cast<dsm::BlockId>(frame);
    RunFrame(messenger, first,
      [&](dsm::PagedStore::Worker& worker, int)
      {
        EXPECT_EQ(Visit(first, worker, *one, id), 0u);
        EXPECT_EQ(Visit(first, worker, *three, id + 5), 0u);
        EXPECT_EQ(Visit(first, worker, *three, id + 6), 0u);
      });
    RunFrame(messenger, second,
      [&](dsm::PagedStore::Worker& worker, int)
      { EXPECT_EQ(Visit(second, worker, *two, id + 1), 0u); });
    first.Retire(three);
    three = PublishPattern(messenger, first, large);
  }
}

/// Threads that wait, politely or in a fault, get out; the next frame is as good as new.
inline void PagedCancelWakesWaitingWorkers(dsm::Messenger& messenger, const Way& way)
{
  const int size = messenger.GetSize();
  const std::uint32_t bytes = static_cast<std::uint32_t>(3 * GetPage());
  const auto directory = MakeDirectory(size, 2 * static_cast<std::size_t>(size), bytes);
  dsm::PagedStore store(messenger, way.GetSettings(1 << 16, 3));
  const auto segment = PublishPattern(messenger, store, directory);
  const dsm::BlockId remote = static_cast<dsm::BlockId>((messenger.GetRank() + 1) % size);
  for (int round = 0; round < 4; ++round)
  {
    store.BeginFrame();
    // Nobody services, so a miss waits until it is cancelled.
    std::vector<std::string> causes(3);
    std::vector<std::thread> threads;
    std::atomic<int> entered{ 0 };
    for (int index = 0; index < 3; ++index)
    {
      threads.emplace_back(
        [&, index]
        {
          dsm::PagedStore::Worker& worker = store.GetWorker(index);
          store.Enter(worker);
          ++entered;
          try
          {
            for (;;)
            {
              const auto pin = store.Acquire(worker, *segment, remote);
              // Either the block or zeros.
              const std::size_t wrong = CountWrongBytes(remote, pin.GetData(), pin.GetBytes());
              EXPECT_TRUE(wrong == 0 || size > 1);
            }
          }
          catch (const dsm::Error& error)
          {
            causes[static_cast<std::size_t>(index)] = error.what();
          }
          EXPECT_THROW(store.Acquire(worker, *segment, remote), dsm::Error);
          store.Leave(worker);
        });
    }
    while (entered < 3)
    {
      std::this_thread::yield();
    }
    // Long enough to fault, or not at all: both must do.
    std::this_thread::sleep_for(std::chrono::milliseconds(10 * (round % 2)));
    for (int i = 0; i < round / 2; ++i)
    {
      store.Service(); // the request leaves, but no answer is taken
    }
    store.Cancel("the user gave up");
    store.Cancel("a later cause");
    for (std::thread& thread : threads)
    {
      thread.join();
    }
    store.EndFrame();
    for (const std::string& cause : causes)
    {
      EXPECT_EQ(cause, "the user gave up");
    }
    messenger.Barrier();
    EXPECT_EQ(store.GetCounters().CachedBytes, 0u);
    RunFrame(messenger, store,
      [&](dsm::PagedStore::Worker& worker, int)
      {
        if (round == 3) // else the next round would find it here
        {
          EXPECT_EQ(Visit(store, worker, *segment, remote), 0u);
        }
        EXPECT_EQ(
          Visit(store, worker, *segment, static_cast<dsm::BlockId>(messenger.GetRank())), 0u);
      });
  }
}

inline void PagedLateRepliesOfACancelledFrameAreIgnored(dsm::Messenger& messenger, const Way& way)
{
  const int size = messenger.GetSize();
  const auto directory = MakeDirectory(size, 6 * static_cast<std::size_t>(size), 1000);
  dsm::PagedStore store(messenger, way.GetSettings(GetPage()));
  const auto segment = PublishPattern(messenger, store, directory);
  const dsm::BlockId remote = static_cast<dsm::BlockId>((messenger.GetRank() + 1) % size);
  for (int round = 0; round < 12; ++round)
  {
    store.BeginFrame();
    std::thread tracer(
      [&]
      {
        dsm::PagedStore::Worker& worker = store.GetWorker(0);
        store.Enter(worker);
        try
        {
          Visit(store, worker, *segment, remote + static_cast<dsm::BlockId>(size * (round % 6)));
        }
        catch (const dsm::Error&)
        {
          // Whether the frame ended first is a matter of luck.
        }
        store.Leave(worker);
      });
    for (int i = 0; i < round * 30; ++i)
    {
      store.Service(); // the request leaves, but no answer is taken
      std::this_thread::yield();
    }
    store.Cancel("cut short");
    tracer.join();
    store.EndFrame();
    RunFrame(messenger, store,
      [&](dsm::PagedStore::Worker& worker, int)
      {
        for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
        {
          EXPECT_EQ(Visit(store, worker, *segment, id), 0u);
        }
      });
    EXPECT_LE(store.GetCounters().PeakCachedBytes, GetPage());
  }
}

/// Settings change between frames; what is cached beyond a smaller budget goes.
inline void PagedCacheShrinksBetweenFrames(dsm::Messenger& messenger, const Way& way)
{
  const int size = messenger.GetSize();
  const std::size_t page = GetPage();
  const auto directory = MakeDirectory(size, 16 * static_cast<std::size_t>(size), 640);
  dsm::PagedStore store(messenger, way.GetSettings(1 << 20, 1));
  const auto segment = PublishPattern(messenger, store, directory);
  const auto look = [&](dsm::PagedStore::Worker& worker, int)
  {
    for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
    {
      EXPECT_EQ(Visit(store, worker, *segment, id), 0u);
    }
  };
  RunFrame(messenger, store, look);
  EXPECT_EQ(store.GetCounters().CachedBytes, page * 16 * static_cast<unsigned>(size - 1));
  store.SetSettings(way.GetSettings(3 * page, 4));
  EXPECT_LE(store.GetCounters().CachedBytes, 3 * page);
  RunFrame(messenger, store, look);
  EXPECT_EQ(store.GetWorkerCounters().size(), 4u);
  EXPECT_EQ(store.GetCounters().Workers.Accesses, 4 * directory.GetCount());
  EXPECT_LE(store.GetCounters().PeakCachedBytes, 3 * page);
}

inline void PagedCacheSmallerThanOneBrickIsRefused(dsm::Messenger& messenger, const Way& way)
{
  const int size = messenger.GetSize();
  const int last = size - 1;
  const auto directory = MakeDirectory(size, 8, 1000);
  // Only the last rank's cache is too small; all must hear of it.
  dsm::PagedStore store(
    messenger, way.GetSettings(messenger.GetRank() == last ? GetPage() - 1 : 1 << 20));
  const auto segment = PublishPattern(messenger, store, directory);
  const auto look = [&](dsm::PagedStore::Worker& worker, int)
  { EXPECT_EQ(Visit(store, worker, *segment, 3), 0u); };
  if (size > 1)
  {
    const std::string text = GetErrorText([&] { RunFrame(messenger, store, look); });
    EXPECT_NE(text.find("Rank " + std::to_string(last)), std::string::npos) << text;
    EXPECT_NE(
      text.find("The cache of " + std::to_string(GetPage() - 1) + " bytes"), std::string::npos)
      << text;
    EXPECT_NE(text.find("DSMCacheSize"), std::string::npos) << text;
    store.SetSettings(way.GetSettings(GetPage()));
  }
  RunFrame(messenger, store, look);
}

/// Random blocks of random sizes, several workers, a cache of three of the largest; every byte.
inline void PagedRandomAccess(dsm::Messenger& messenger, const Way& way, int workers, int accesses)
{
  const int size = messenger.GetSize();
  const std::size_t page = GetPage();
  std::minstd_rand sizes(7);
  std::vector<std::uint32_t> bytes(97);
  for (auto& count : bytes)
  {
    count = 1 + static_cast<std::uint32_t>(sizes() % 256);
  }
  bytes[50] = static_cast<std::uint32_t>(page) + 1;
  const dsm::BlockDirectory directory(bytes, dsm::RoundRobinAssigner(size));
  const std::size_t capacity = 6 * page;
  dsm::PagedStore store(messenger, way.GetSettings(capacity, workers));
  const auto segment = PublishPattern(messenger, store, directory);
  for (int frame = 0; frame < 2; ++frame)
  {
    RunFrame(messenger, store,
      [&](dsm::PagedStore::Worker& worker, int index)
      {
        std::minstd_rand random(
          static_cast<unsigned>(1 + frame + 10 * index + 100 * messenger.GetRank()));
        std::size_t wrong = 0;
        for (int i = 0; i < accesses / 2; ++i)
        {
          // Most accesses go to few blocks, so that hits and evictions meet.
          const dsm::BlockId id = random() % (random() % 8 != 0 ? 5 : directory.GetCount());
          wrong += Visit(store, worker, *segment, id);
        }
        EXPECT_EQ(wrong, 0u);
      });
    const auto counters = store.GetCounters();
    EXPECT_LE(counters.PeakCachedBytes, capacity);
    EXPECT_EQ(counters.Workers.Accesses, static_cast<std::uint64_t>(workers * (accesses / 2)));
    EXPECT_EQ(counters.Evictions > 0, size > 1);
  }
}

} // namespace dsm_test

#endif
