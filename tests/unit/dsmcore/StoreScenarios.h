// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_StoreScenarios_h
#define dsm_test_StoreScenarios_h

#include "tests/unit/dsmcore/StoreTestTools.h"

#include <cstdint>
#include <new>
#include <random>
#include <string>
#include <vector>

/// What the object store must do on any transport and number of ranks; each is run by every rank.
namespace dsm_test
{

inline dsm::ObjectStore::Settings MakeSettings(std::size_t cacheBytes, int workers = 1)
{
  dsm::ObjectStore::Settings settings;
  settings.CacheBytes = cacheBytes;
  settings.Workers = workers;
  return settings;
}

inline void EveryByteArrives(dsm::Messenger& messenger, Spread spread)
{
  const int size = messenger.GetSize();
  // Odd sizes, among them nothing, one byte, and one larger than any eager limit of MPI.
  const dsm::BlockDirectory directory(
    { 0, 1, 63, 64, 65, 4097, 300001, 12, 5000, 0, 777 }, dsm::RoundRobinAssigner(size));
  dsm::ObjectStore store(messenger, MakeSettings(std::size_t(1) << 20));
  const auto segment = PublishPattern(messenger, store, directory, spread, 40000);
  std::vector<dsm::BlockId> owned;
  segment->ForEachResident(
    [&](dsm::BlockId id, const std::byte* block, std::size_t bytes)
    {
      EXPECT_EQ(directory.GetOwner(id), messenger.GetRank());
      EXPECT_EQ(bytes, directory.GetBytes(id));
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % dsm::BlockAlignment, 0u);
      EXPECT_EQ(CountWrongBytes(id, block, bytes), 0u);
      owned.push_back(id);
    });
  EXPECT_TRUE(std::is_sorted(owned.begin(), owned.end()));
  EXPECT_EQ(segment->GetResidentBytes(), directory.GetResidentBytes(messenger.GetRank()));
  RunFrame(messenger, store,
    [&](dsm::ObjectStore::Worker& worker, int)
    {
      for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
      {
        EXPECT_EQ(Visit(store, worker, *segment, id), 0u) << "block " << id;
      }
    });
  store.Retire(segment);
}

inline void EveryRankPublishesASlice(dsm::Messenger& messenger)
{
  EveryByteArrives(messenger, Spread::EveryRankASlice);
}

inline void OneRankHasEverything(dsm::Messenger& messenger)
{
  EveryByteArrives(messenger, Spread::OnlyRankZero);
}

inline void OneRankHasNoData(dsm::Messenger& messenger)
{
  EveryByteArrives(messenger, Spread::OnlyLastRank);
}

inline void NoBlocksAtAll(dsm::Messenger& messenger)
{
  dsm::ObjectStore store(messenger, MakeSettings(0));
  const auto segment = PublishPattern(messenger, store, MakeDirectory(messenger.GetSize(), 0, 0));
  segment->ForEachResident(
    [](dsm::BlockId id, const std::byte*, std::size_t) { ADD_FAILURE() << "block " << id; });
  RunFrame(messenger, store, [](dsm::ObjectStore::Worker&, int) {});
  EXPECT_EQ(store.GetCounters().ResidentBytes, 0u);
}

/// More bytes than a rank may have under way, from one rank to one: the stream must flow.
inline void LargeFragmentsFlow(dsm::Messenger& messenger)
{
  const auto directory = MakeDirectory(messenger.GetSize(), 8, std::uint32_t(4) << 20);
  dsm::ObjectStore store(messenger, MakeSettings(0));
  double last = -1.0;
  PatternSource source(directory, messenger.GetRank(), messenger.GetSize(), Spread::EveryRankASlice,
    std::size_t(3) << 20);
  PatternSink sink;
  const auto segment = store.Publish("Publishing", directory, source, sink,
    [&](double part)
    {
      EXPECT_GT(part, last);
      EXPECT_LE(part, 1.0);
      last = part;
    });
  EXPECT_GE(last, 1.0);
  EXPECT_EQ(sink.Absorbed, sink.Expected);
}

inline void HitsMissesAndEvictionsAreExact(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  const std::uint64_t remote = 9 * static_cast<std::uint64_t>(size - 1); // of 9 blocks a rank
  const std::uint32_t bytes = 1024;
  const auto directory = MakeDirectory(size, 9 * static_cast<std::size_t>(size), bytes);
  dsm::ObjectStore store(messenger, MakeSettings(4 * bytes));
  const auto segment = PublishPattern(messenger, store, directory);
  const std::uint64_t count = directory.GetCount();

  RunFrame(messenger, store,
    [&](dsm::ObjectStore::Worker& worker, int)
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
  EXPECT_EQ(counters.ResidentBytes, 9 * bytes);
  EXPECT_EQ(counters.CachedBytes, std::min<std::uint64_t>(remote, 4) * bytes);
  EXPECT_EQ(counters.PeakCachedBytes, counters.CachedBytes);
  EXPECT_EQ(counters.CacheCapacity, 4 * bytes);
  EXPECT_EQ(counters.Workers.WaitNanoseconds > 0, remote > 0);
  EXPECT_EQ(store.GetWorkerCounters().size(), 1u);
  EXPECT_EQ(store.GetWorkerCounters().front().Accesses, 2 * count);

  // What was fetched last is still here in the next frame, whose counters start afresh.
  RunFrame(messenger, store,
    [&](dsm::ObjectStore::Worker& worker, int)
    {
      const dsm::BlockId last = messenger.GetRank() == size - 1 && size > 1 ? count - 2 : count - 1;
      EXPECT_EQ(Visit(store, worker, *segment, last), 0u);
    });
  EXPECT_EQ(store.GetCounters().Workers.Accesses, 1u);
  EXPECT_EQ(store.GetCounters().Workers.Misses, 0u);
  EXPECT_EQ(store.GetCounters().BytesReceived, 0u);
  store.Retire(segment);
  EXPECT_EQ(store.GetCounters().CachedBytes, 0u);
  EXPECT_EQ(store.GetCounters().ResidentBytes, 0u);
}

/// A cache of one block and eight workers that want different ones must get on.
inline void CacheHoldsOneBrick(dsm::Messenger& messenger)
{
  const std::uint32_t bytes = 512;
  const int workers = 8;
  const auto directory =
    MakeDirectory(messenger.GetSize(), 4 * static_cast<std::size_t>(messenger.GetSize()), bytes);
  dsm::ObjectStore store(messenger, MakeSettings(bytes, workers));
  const auto segment = PublishPattern(messenger, store, directory);
  RunFrame(messenger, store,
    [&](dsm::ObjectStore::Worker& worker, int index)
    {
      std::minstd_rand random(static_cast<unsigned>(index + 10 * messenger.GetRank() + 1));
      for (int i = 0; i < 60; ++i)
      {
        EXPECT_EQ(Visit(store, worker, *segment, random() % directory.GetCount()), 0u);
        store.Quiesce(worker);
      }
    });
  const auto counters = store.GetCounters();
  EXPECT_EQ(counters.Workers.Accesses, 60u * workers);
  EXPECT_EQ(counters.Workers.Hits + counters.Workers.Misses, counters.Workers.Accesses);
  EXPECT_LE(counters.PeakCachedBytes, bytes);
  // Every miss that did not join was answered by one block.
  EXPECT_EQ(counters.BytesReceived, (counters.Workers.Misses - counters.Workers.Joins) * bytes);
}

/// Workers that never pass a quiescent point of their own accord but by missing.
inline void MissesAreQuiescentPoints(dsm::Messenger& messenger)
{
  const std::uint32_t bytes = 256;
  const auto directory =
    MakeDirectory(messenger.GetSize(), 8 * static_cast<std::size_t>(messenger.GetSize()), bytes);
  dsm::ObjectStore store(messenger, MakeSettings(2 * bytes, 2));
  const auto segment = PublishPattern(messenger, store, directory);
  RunFrame(messenger, store,
    [&](dsm::ObjectStore::Worker& worker, int index)
    {
      for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
      {
        const dsm::BlockId shifted =
          (id + static_cast<dsm::BlockId>(3 * index)) % directory.GetCount();
        EXPECT_EQ(Visit(store, worker, *segment, shifted), 0u);
      }
    });
  EXPECT_LE(store.GetCounters().PeakCachedBytes, 2 * bytes);
}

inline void FirstMissSendsLaterOnesJoin(dsm::Messenger& messenger)
{
  const int workers = 4;
  const auto directory = MakeDirectory(messenger.GetSize(), 64, 2048);
  dsm::ObjectStore store(messenger, MakeSettings(std::size_t(1) << 20, workers));
  const auto segment = PublishPattern(messenger, store, directory);
  RunFrame(messenger, store,
    [&](dsm::ObjectStore::Worker& worker, int)
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

/// Two stores on one messenger, as two views have them; their numbers must not be confused.
inline void StoresShareAMessenger(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  dsm::ObjectStore first(messenger, MakeSettings(1 << 16));
  dsm::ObjectStore second(messenger, MakeSettings(1 << 16));
  const auto small = MakeDirectory(size, 12, 100);
  const auto large = MakeDirectory(size, 20, 3000);
  const auto one = PublishPattern(messenger, first, small);
  const auto two = PublishPattern(messenger, second, large);
  const auto three = PublishPattern(messenger, first, large);
  EXPECT_NE(one->GetNumber(), two->GetNumber());
  EXPECT_NE(one->GetNumber(), three->GetNumber());
  const auto numbers = messenger.AllGatherValue(three->GetNumber());
  EXPECT_EQ(numbers.front(), numbers.back());
  for (int frame = 0; frame < 10; ++frame)
  {
    RunFrame(messenger, first,
      [&](dsm::ObjectStore::Worker& worker, int)
      {
        EXPECT_EQ(Visit(first, worker, *one, static_cast<dsm::BlockId>(frame)), 0u);
        EXPECT_EQ(Visit(first, worker, *three, static_cast<dsm::BlockId>(frame + 5)), 0u);
      });
    RunFrame(messenger, second,
      [&](dsm::ObjectStore::Worker& worker, int)
      { EXPECT_EQ(Visit(second, worker, *two, static_cast<dsm::BlockId>(frame + 1)), 0u); });
  }
}

/// A source that fails on the last rank after a while.
class FailingSource final : public PatternSource
{
public:
  using PatternSource::PatternSource;
  bool Next(dsm::Fragment& fragment) override
  {
    if (++this->Calls > 3)
    {
      throw std::bad_alloc();
    }
    return this->PatternSource::Next(fragment);
  }

private:
  int Calls = 0;
};

/// A sink that fails in one of its steps.
class FailingSink final : public PatternSink
{
public:
  enum class Step
  {
    Begin,
    Absorb,
    Finish
  };
  explicit FailingSink(Step step)
    : At(step)
  {
  }
  void Begin(dsm::BlockId id, std::byte* block, std::size_t bytes) override
  {
    this->FailIf(Step::Begin);
    this->PatternSink::Begin(id, block, bytes);
  }
  void Absorb(dsm::BlockId id, std::byte* block, std::size_t bytes, const std::byte* fragment,
    std::size_t fragmentBytes) override
  {
    this->FailIf(Step::Absorb);
    this->PatternSink::Absorb(id, block, bytes, fragment, fragmentBytes);
  }
  void Finish(dsm::BlockId id, std::byte* block, std::size_t bytes) override
  {
    this->FailIf(Step::Finish);
    this->PatternSink::Finish(id, block, bytes);
  }

private:
  void FailIf(Step step) const
  {
    if (this->At == step)
    {
      throw dsm::Error("the sink is stopped up");
    }
  }
  Step At;
};

inline void FailingPublishFailsEverywhereAndTheNextWorks(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  const int last = size - 1;
  const std::string name = last > 0 ? "Rank " + std::to_string(last) + ": " : "";
  const auto directory = MakeDirectory(size, 40, 3000);
  dsm::ObjectStore store(messenger, MakeSettings(1 << 20));
  {
    PatternSource good(directory, messenger.GetRank(), size, Spread::EveryRankASlice, 500);
    FailingSource bad(directory, messenger.GetRank(), size, Spread::EveryRankASlice, 500);
    PatternSink sink;
    const std::string text = GetErrorText(
      [&]
      {
        dsm::FragmentSource& source =
          messenger.GetRank() == last ? static_cast<dsm::FragmentSource&>(bad) : good;
        store.Publish("Loading 'Pressure'", directory, source, sink);
      });
    EXPECT_EQ(text.find("Loading 'Pressure': " + name + "out of memory"), 0u) << text;
  }
  for (const FailingSink::Step step :
    { FailingSink::Step::Begin, FailingSink::Step::Absorb, FailingSink::Step::Finish })
  {
    PatternSource source(directory, messenger.GetRank(), size, Spread::EveryRankASlice, 500);
    PatternSink good;
    FailingSink bad(step);
    const std::string text = GetErrorText(
      [&]
      {
        store.Publish("Loading", directory, source,
          messenger.GetRank() == last ? static_cast<dsm::FragmentSink&>(bad) : good);
      });
    EXPECT_EQ(text, "Loading: " + name + "the sink is stopped up");
  }
  EXPECT_EQ(store.GetCounters().ResidentBytes, 0u) << "a failed publication leaves nothing";
  const auto segment = PublishPattern(messenger, store, directory);
  RunFrame(messenger, store,
    [&](dsm::ObjectStore::Worker& worker, int)
    { EXPECT_EQ(Visit(store, worker, *segment, 1), 0u); });
}

inline void RanksThatDisagreeAboutTheBlocksAreTold(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  if (size == 1)
  {
    return; // nobody to disagree with
  }
  const auto directory = MakeDirectory(size, messenger.GetRank() == size - 1 ? 5 : 4, 100);
  dsm::ObjectStore store(messenger, MakeSettings(1 << 20));
  PatternSource source(directory, messenger.GetRank(), size, Spread::EveryRankASlice, 500);
  PatternSink sink;
  const std::string text = GetErrorText([&] { store.Publish("Loading", directory, source, sink); });
  EXPECT_NE(text.find("disagree"), std::string::npos) << text;
}

inline void CacheSmallerThanOneBrickIsRefused(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  const auto directory = MakeDirectory(size, 8, 1000);
  const int last = size - 1;
  // Only the last rank's cache is too small; all must hear of it.
  dsm::ObjectStore store(messenger, MakeSettings(messenger.GetRank() == last ? 1000 : 100000));
  const auto segment = PublishPattern(messenger, store, directory);
  const auto look = [&](dsm::ObjectStore::Worker& worker, int)
  { EXPECT_EQ(Visit(store, worker, *segment, 3), 0u); };
  if (size > 1)
  {
    const std::string text = GetErrorText([&] { RunFrame(messenger, store, look); });
    EXPECT_NE(text.find("Rank " + std::to_string(last)), std::string::npos) << text;
    EXPECT_NE(text.find("The cache of 1000 bytes"), std::string::npos) << text;
    EXPECT_NE(text.find("DSMCacheSize"), std::string::npos) << text;
    store.SetSettings(MakeSettings(1024));
  }
  RunFrame(messenger, store, look);
}

/// Waiting workers hear of a cancellation at once; the next frame is as good as new.
inline void CancelWakesWaitingWorkers(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  const auto directory = MakeDirectory(size, static_cast<std::size_t>(size), 1000);
  dsm::ObjectStore store(messenger, MakeSettings(1 << 16, 3));
  const auto segment = PublishPattern(messenger, store, directory);
  const dsm::BlockId remote = static_cast<dsm::BlockId>((messenger.GetRank() + 1) % size);
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
        dsm::ObjectStore::Worker& worker = store.GetWorker(index);
        store.Enter(worker);
        ++entered;
        try
        {
          EXPECT_EQ(Visit(store, worker, *segment, remote), 0u);
        }
        catch (const dsm::Error& error)
        {
          causes[static_cast<std::size_t>(index)] = error.what();
        }
        // Later misses fail too; hits do not.
        if (size > 1)
        {
          EXPECT_THROW(store.Acquire(worker, *segment, remote), dsm::Error);
        }
        EXPECT_EQ(
          Visit(store, worker, *segment, static_cast<dsm::BlockId>(messenger.GetRank())), 0u);
        store.Leave(worker);
      });
  }
  while (entered < 3)
  {
    std::this_thread::yield();
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
    EXPECT_EQ(cause, size > 1 ? "the user gave up" : "");
  }
  messenger.Barrier();
  RunFrame(messenger, store,
    [&](dsm::ObjectStore::Worker& worker, int)
    { EXPECT_EQ(Visit(store, worker, *segment, remote), 0u); });
}

/// Requests of a cancelled frame, and the answers to them, meet the next one.
inline void LateRepliesOfACancelledFrameAreIgnored(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  const auto directory = MakeDirectory(size, 6 * static_cast<std::size_t>(size), 1000);
  dsm::ObjectStore store(messenger, MakeSettings(1024));
  const auto segment = PublishPattern(messenger, store, directory);
  const dsm::BlockId remote = static_cast<dsm::BlockId>((messenger.GetRank() + 1) % size);
  for (int round = 0; round < 20; ++round)
  {
    store.BeginFrame();
    std::thread tracer(
      [&]
      {
        dsm::ObjectStore::Worker& worker = store.GetWorker(0);
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
    for (int i = 0; i < round * 20; ++i)
    {
      store.Service(); // the request leaves, but no answer is taken
      std::this_thread::yield();
    }
    store.Cancel("cut short");
    tracer.join();
    store.EndFrame();
    RunFrame(messenger, store,
      [&](dsm::ObjectStore::Worker& worker, int)
      {
        for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
        {
          EXPECT_EQ(Visit(store, worker, *segment, id), 0u);
        }
      });
    EXPECT_LE(store.GetCounters().PeakCachedBytes, 1024u);
  }
}

/// Settings change between frames; what is cached beyond a smaller budget goes.
inline void CacheShrinksBetweenFrames(dsm::Messenger& messenger)
{
  const int size = messenger.GetSize();
  const auto directory = MakeDirectory(size, 16 * static_cast<std::size_t>(size), 640);
  dsm::ObjectStore store(messenger, MakeSettings(1 << 20, 1));
  const auto segment = PublishPattern(messenger, store, directory);
  const auto look = [&](dsm::ObjectStore::Worker& worker, int)
  {
    for (dsm::BlockId id = 0; id < directory.GetCount(); ++id)
    {
      EXPECT_EQ(Visit(store, worker, *segment, id), 0u);
    }
  };
  RunFrame(messenger, store, look);
  EXPECT_EQ(store.GetCounters().CachedBytes, 640u * 16 * static_cast<unsigned>(size - 1));
  store.SetSettings(MakeSettings(3 * 640, 4));
  EXPECT_LE(store.GetCounters().CachedBytes, 3 * 640u);
  RunFrame(messenger, store, look);
  EXPECT_EQ(store.GetWorkerCounters().size(), 4u);
  EXPECT_EQ(store.GetCounters().Workers.Accesses, 4 * directory.GetCount());
  EXPECT_LE(store.GetCounters().PeakCachedBytes, 3 * 640u);
  store.SetSettings(MakeSettings(1 << 20, 1));
  RunFrame(messenger, store, look);
}

/// Random blocks of random sizes, several workers, a cache of three of the largest; every byte.
inline void RandomAccessThroughASmallCache(dsm::Messenger& messenger, int workers, int accesses)
{
  const int size = messenger.GetSize();
  std::minstd_rand sizes(7);
  std::vector<std::uint32_t> bytes(97);
  for (auto& count : bytes)
  {
    count = 1 + static_cast<std::uint32_t>(sizes() % 256);
  }
  const dsm::BlockDirectory directory(bytes, dsm::RoundRobinAssigner(size));
  const std::size_t capacity = 3 * 256;
  dsm::ObjectStore store(messenger, MakeSettings(capacity, workers));
  const auto segment = PublishPattern(messenger, store, directory);
  for (int frame = 0; frame < 2; ++frame)
  {
    RunFrame(messenger, store,
      [&](dsm::ObjectStore::Worker& worker, int index)
      {
        std::minstd_rand random(
          static_cast<unsigned>(1 + frame + 10 * index + 100 * messenger.GetRank()));
        std::size_t wrong = 0;
        for (int i = 0; i < accesses / 2; ++i)
        {
          // Half of the accesses go to few blocks, so that hits and evictions meet.
          const dsm::BlockId id = random() % (random() % 2 == 0 ? 5 : directory.GetCount());
          wrong += Visit(store, worker, *segment, id);
          if (i % 64 == 0)
          {
            store.Quiesce(worker);
          }
        }
        EXPECT_EQ(wrong, 0u);
      });
    const auto counters = store.GetCounters();
    EXPECT_LE(counters.PeakCachedBytes, capacity);
    EXPECT_EQ(counters.Workers.Accesses, static_cast<std::uint64_t>(workers * (accesses / 2)));
    EXPECT_EQ(counters.Workers.Hits + counters.Workers.Misses, counters.Workers.Accesses);
    EXPECT_EQ(counters.Evictions > 0, size > 1);
  }
}

} // namespace dsm_test

#endif
