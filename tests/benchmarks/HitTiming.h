// SPDX-License-Identifier: BSD-3-Clause
#ifndef HitTiming_h
#define HitTiming_h

#include "AccessBenchmark.h"
#include "AccessFrame.h"
#include "NumberedWords.h"

#include "DSMCore/memory/BlockArena.h"

#include <algorithm>
#include <atomic>
#include <ctime>

/// What a hit costs.

namespace AccessTiming
{

/// Nanoseconds for each access, of the slowest thread in the fastest round.
struct Cost
{
  double Independent = 0.0;
  double Dependent = 0.0;
};

/// Processor time of this thread, so that other programs on the machine count as little as may be.
inline double GetThreadNanoseconds()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

/// The yardstick: one array of all numbers, on rank 0.
class RawArray
{
public:
  RawArray(std::uint64_t bytes, std::uint32_t blockBytes)
    : Memory(bytes)
    , BlockBytes(blockBytes)
    , Blocks(bytes / blockBytes)
  {
    FillWithNumbers(this->Memory.GetData(), bytes, 0);
  }

  /// Nanoseconds for each access, of the slowest thread.
  double Time(rt::WorkerPool& pool, int threads, std::uint64_t accesses, bool dependent, int round)
  {
    std::vector<double> times(static_cast<std::size_t>(threads));
    std::atomic<std::uint64_t> wrong{ 0 };
    pool.Start(
      threads,
      [&](int index)
      {
        const double start = GetThreadNanoseconds();
        const std::byte* const data = this->Memory.GetData();
        const std::uint64_t blockBytes = this->BlockBytes;
        wrong |= ReadWords(
          accesses, this->Blocks, blockBytes / sizeof(std::uint64_t),
          static_cast<std::uint64_t>(index + 8 * round + 1), dependent,
          [](std::uint64_t block) { return block; },
          [=](std::uint64_t block, std::uint64_t word)
          {
            std::uint64_t value;
            std::memcpy(&value, data + block * blockBytes + word * sizeof(value), sizeof(value));
            return value;
          });
        times[static_cast<std::size_t>(index)] =
          (GetThreadNanoseconds() - start) / static_cast<double>(accesses);
      },
      [] {});
    pool.Wait();
    CheckWords(wrong);
    return *std::max_element(times.begin(), times.end());
  }

private:
  dsm::BlockArena Memory;
  std::uint32_t BlockBytes;
  std::uint64_t Blocks;
};

struct HitCost
{
  Cost Array;
  Cost Store;
};

/// Everything is on rank 0 before the clock starts. Array and store take turns, so that what else
/// the machine does meets both; `array` is null on the other ranks. `remoteOnly`: blocks of other
/// ranks. Collective.
template <class Store>
HitCost TimeHits(const AccessBenchmark::Options& options, dsm::Messenger& messenger, Store& store,
  const dsm::BlockSegment& segment, bool remoteOnly, RawArray* array)
{
  using Worker = typename Store::Worker;
  const std::uint64_t words = options.BlockBytes / sizeof(std::uint64_t);
  const std::uint64_t blocks = segment.GetDirectory().GetCount();
  const auto ranks = static_cast<std::uint64_t>(messenger.GetSize());
  const bool some = remoteOnly && ranks > 1;
  const std::uint64_t choices = some ? blocks / ranks * (ranks - 1) : blocks;
  // Block n belongs to rank n mod N; rank 0 reads.
  const auto choose = [=](std::uint64_t block)
  { return some ? block / (ranks - 1) * ranks + 1 + block % (ranks - 1) : block; };
  const int workers = store.GetSettings().Workers;
  const int reading = messenger.GetRank() == 0 ? workers : 0;
  rt::WorkerPool pool;
  RunFrame<Store>(messenger, store, pool, reading,
    [&](Worker& worker, int)
    {
      for (std::uint64_t id = 0; id < blocks; ++id)
      {
        const auto pin = store.Acquire(worker, segment, id);
        std::uint64_t value;
        // Every page once, where blocks come by page faults.
        for (std::size_t at = 0; at < options.BlockBytes; at += 4096)
        {
          std::memcpy(&value, pin.GetData() + at, sizeof(value));
          CheckWords(value - id * words - at / sizeof(value));
        }
      }
    });
  HitCost cost{ { 1e300, 1e300 }, { 1e300, 1e300 } };
  for (int round = 0; round < 2 * options.Repeat; ++round)
  {
    const bool dependent = round % 2 != 0;
    // A read that waits for the one before takes many times as long.
    const std::uint64_t accesses = dependent ? options.Accesses / 4 + 1 : options.Accesses;
    if (array)
    {
      double& best = dependent ? cost.Array.Dependent : cost.Array.Independent;
      best = std::min(best, array->Time(pool, workers, accesses, dependent, round));
    }
    std::vector<double> times(static_cast<std::size_t>(workers), 0.0);
    RunFrame<Store>(messenger, store, pool, reading,
      [&](Worker& worker, int index)
      {
        const double start = GetThreadNanoseconds();
        CheckWords(ReadWords(accesses, choices, words,
          static_cast<std::uint64_t>(index + 8 * round + 1), dependent, choose,
          [&](std::uint64_t block, std::uint64_t word)
          {
            const auto pin = store.Acquire(worker, segment, block);
            std::uint64_t value;
            std::memcpy(&value, pin.GetData() + word * sizeof(value), sizeof(value));
            return value;
          }));
        times[static_cast<std::size_t>(index)] =
          (GetThreadNanoseconds() - start) / static_cast<double>(accesses);
      });
    double& best = dependent ? cost.Store.Dependent : cost.Store.Independent;
    best = std::min(best, *std::max_element(times.begin(), times.end()));
    messenger.RunTogether("Timing hits",
      [&]
      {
        if (store.GetCounters().Workers.Misses != 0)
        {
          throw dsm::Error("there were misses.");
        }
      });
  }
  return cost;
}

} // namespace AccessTiming

#endif
