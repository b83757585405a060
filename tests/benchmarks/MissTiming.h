// SPDX-License-Identifier: BSD-3-Clause
#ifndef MissTiming_h
#define MissTiming_h

#include "AccessBenchmark.h"
#include "AccessFrame.h"
#include "NumberedWords.h"

#include <algorithm>
#include <chrono>

/// What a miss costs.

namespace AccessTiming
{

inline double NanosecondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}

/// Nanoseconds of a miss: rank 0 walks through the blocks of rank 1, of which the cache holds few.
template <class Store>
inline double TimeMisses(const AccessBenchmark::Options& options, dsm::Messenger& messenger,
  Store& store, const dsm::BlockSegment& segment)
{
  const std::uint64_t words = options.BlockBytes / sizeof(std::uint64_t);
  const auto ranks = static_cast<std::uint64_t>(messenger.GetSize());
  const std::uint64_t blocks = segment.GetDirectory().GetCount() / ranks;
  rt::WorkerPool pool;
  double best = 1e300;
  for (int round = 0; round < options.Repeat; ++round)
  {
    double time = 0.0;
    RunFrame<Store>(messenger, store, pool, messenger.GetRank() == 0 ? 1 : 0,
      [&](typename Store::Worker& worker, int)
      {
        const auto start = std::chrono::steady_clock::now();
        for (std::uint64_t i = 0; i < options.Misses; ++i)
        {
          const std::uint64_t id = (i * 7919 % blocks) * ranks + 1;
          const auto pin = store.Acquire(worker, segment, id);
          std::uint64_t value;
          std::memcpy(&value, pin.GetData(), sizeof(value));
          CheckWords(value - id * words);
          store.Quiesce(worker);
        }
        time = NanosecondsSince(start) / static_cast<double>(options.Misses);
      });
    messenger.RunTogether("Timing misses",
      [&]
      {
        if (messenger.GetRank() == 0 &&
          store.GetCounters().Workers.Misses < options.Misses * 99 / 100)
        {
          throw dsm::Error("there were hits.");
        }
      });
    best = std::min(best, time);
  }
  return best;
}

/// Nanoseconds of the bare exchange that a miss is made of: a small message to rank 1, and one of a
/// block's size back, both ranks polling without rest.
inline double TimeExchange(const AccessBenchmark::Options& options, dsm::Messenger& messenger)
{
  const int rank = messenger.GetRank();
  double best = 1e300;
  for (int round = 0; round < options.Repeat; ++round)
  {
    messenger.BeginSession();
    std::uint64_t answered = 0;
    std::uint64_t asked = 0;
    messenger.SetHandler(dsm::MessageKind::BlockReply, [&](dsm::Message&&) { ++answered; });
    messenger.SetHandler(dsm::MessageKind::BlockRequest,
      [&](dsm::Message&& message)
      {
        ++asked;
        messenger.Post(
          message.Source, dsm::MessageKind::BlockReply, std::vector<std::byte>(options.BlockBytes));
      });
    messenger.Barrier();
    messenger.BeginSession();
    const auto start = std::chrono::steady_clock::now();
    if (rank == 0)
    {
      for (std::uint64_t i = 0; i < options.Misses; ++i)
      {
        messenger.Post(1, dsm::MessageKind::BlockRequest, std::vector<std::byte>(16));
        while (answered <= i)
        {
          messenger.Progress();
        }
      }
    }
    else if (rank == 1)
    {
      while (asked < options.Misses || messenger.GetUnsentBytes() > 0)
      {
        messenger.Progress();
      }
    }
    best = std::min(best, NanosecondsSince(start) / static_cast<double>(options.Misses));
    messenger.Barrier();
    messenger.SetHandler(dsm::MessageKind::BlockReply, {});
    messenger.SetHandler(dsm::MessageKind::BlockRequest, {});
  }
  return best;
}

} // namespace AccessTiming

#endif
