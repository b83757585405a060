// SPDX-License-Identifier: BSD-3-Clause
#include "AccessBenchmark.h"

#include "OptionValues.h"

#include "DSMCore/BlockArena.h"
#include "DSMCore/BlockStore.h"
#include "DSMRayTracing/frame/FrameAgreement.h"
#include "DSMRayTracing/frame/WorkerPool.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <mutex>
#include <sstream>

namespace
{

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
using Options = AccessBenchmark::Options;

double NanosecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

/// Every 64-bit word of the data holds its own number, so that every access can be checked.
class NumberSource final : public dsm::FragmentSource
{
public:
  NumberSource(const dsm::BlockDirectory& directory, int rank)
    : Directory(directory)
    , Rank(rank)
  {
  }
  bool Next(dsm::Fragment& fragment) override
  {
    while (
      this->Id < this->Directory.GetCount() && this->Directory.GetOwner(this->Id) != this->Rank)
    {
      ++this->Id;
    }
    if (this->Id >= this->Directory.GetCount())
    {
      return false;
    }
    fragment.Block = this->Id++;
    fragment.Bytes.clear();
    return true;
  }
  double GetProgress() const override { return 0.0; }

private:
  const dsm::BlockDirectory& Directory;
  int Rank;
  dsm::BlockId Id = 0;
};

void FillWithNumbers(std::byte* bytes, std::size_t count, std::uint64_t first)
{
  for (std::size_t at = 0; at < count; at += sizeof(first), ++first)
  {
    std::memcpy(bytes + at, &first, sizeof(first));
  }
}

class NumberSink final : public dsm::FragmentSink
{
public:
  void Begin(dsm::BlockId, std::byte*, std::size_t) override {}
  void Absorb(
    dsm::BlockId id, std::byte* block, std::size_t bytes, const std::byte*, std::size_t) override
  {
    FillWithNumbers(block, bytes, id * (bytes / sizeof(std::uint64_t)));
  }
  void Finish(dsm::BlockId, std::byte*, std::size_t) override {}
};

std::shared_ptr<dsm::BlockSegment> PublishNumbers(
  dsm::Messenger& messenger, dsm::BlockStore& store, std::uint64_t bytes, std::uint32_t blockBytes)
{
  const dsm::BlockDirectory directory(std::vector<std::uint32_t>(bytes / blockBytes, blockBytes),
    dsm::RoundRobinAssigner(messenger.GetSize()));
  NumberSource source(directory, messenger.GetRank());
  NumberSink sink;
  return store.Publish("the numbers", directory, source, sink);
}

/// xorshift64; the same for the array and the stores.
struct Random
{
  std::uint64_t State;
  std::uint64_t operator()()
  {
    this->State ^= this->State << 13;
    this->State ^= this->State >> 7;
    this->State ^= this->State << 17;
    return this->State;
  }
};

/// Reads words at random: one of `blocks` blocks that `choose` names by a number below it, then a
/// word of it. Dependent: the next place is not known before the word is read, so the processor
/// cannot read ahead. Returns 0 when all words were right.
template <bool Dependent, class Choose, class Get>
std::uint64_t ReadWords(std::uint64_t count, std::uint64_t blocks, std::uint64_t words,
  std::uint64_t seed, const Choose& choose, const Get& get)
{
  Random random{ seed * 0x9e3779b97f4a7c15u + 1 };
  std::uint64_t wrong = 0;
  for (std::uint64_t i = 0; i < count; ++i)
  {
    const std::uint64_t number = random();
    const std::uint64_t block = choose(((number >> 32) * blocks) >> 32);
    const std::uint64_t word = number & (words - 1);
    const std::uint64_t error = get(block, word) - (block * words + word);
    if constexpr (Dependent)
    {
      random.State ^= error;
    }
    wrong |= error;
  }
  return wrong;
}

template <class Choose, class Get>
std::uint64_t ReadWords(std::uint64_t count, std::uint64_t blocks, std::uint64_t words,
  std::uint64_t seed, bool dependent, const Choose& choose, const Get& get)
{
  return dependent ? ReadWords<true>(count, blocks, words, seed, choose, get)
                   : ReadWords<false>(count, blocks, words, seed, choose, get);
}

/// A frame in which rank 0's workers call `work`, and all ranks serve. Collective.
template <class Store>
void RunFrame(dsm::Messenger& messenger, Store& store, rt::WorkerPool& pool,
  const std::function<void(typename Store::Worker&, int)>& work)
{
  store.BeginFrame();
  rt::FrameAgreement agreement(messenger, [] {});
  messenger.BeginSession();
  const int workers = messenger.GetRank() == 0 ? store.GetSettings().Workers : 0;
  std::mutex guard;
  std::string cause;
  if (workers > 0)
  {
    pool.Start(
      workers,
      [&](int index)
      {
        typename Store::Worker& worker = store.GetWorker(index);
        store.Enter(worker);
        try
        {
          work(worker, index);
        }
        catch (...)
        {
          const std::lock_guard<std::mutex> lock(guard);
          cause = dsm::Messenger::DescribeException();
        }
        store.Leave(worker);
      },
      [&messenger] { messenger.WakeUp(); });
  }
  messenger.ProgressUntil([&] { return agreement.IsOver(); },
    [&]
    {
      bool any = store.Service();
      if (!agreement.IsDone() && (workers == 0 || pool.GetRunning() == 0))
      {
        if (!cause.empty())
        {
          agreement.ReportFailure(cause);
        }
        agreement.ReportDone();
        any = true;
      }
      return any;
    });
  if (workers > 0)
  {
    pool.Wait();
  }
  store.EndFrame();
  messenger.ProgressUntil([&] { return messenger.GetUnsentBytes() == 0; });
  if (!agreement.GetOutcome().IsOk())
  {
    throw dsm::Error(agreement.GetOutcome().Cause);
  }
}

/// Nanoseconds for each access, of the slowest thread in the fastest round.
struct Cost
{
  double Independent = 0.0;
  double Dependent = 0.0;
};

Json ToJson(const Cost& cost)
{
  return { { "independent_ns", cost.Independent }, { "dependent_ns", cost.Dependent } };
}

void CheckWords(std::uint64_t wrong)
{
  if (wrong != 0)
  {
    throw dsm::Error("A word that was read is not the word that was written.");
  }
}

/// Processor time of this thread, so that other programs on the machine count as little as may be.
double GetThreadNanoseconds()
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
HitCost TimeHits(const Options& options, dsm::Messenger& messenger, Store& store,
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
  rt::WorkerPool pool;
  RunFrame<Store>(messenger, store, pool,
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
    RunFrame<Store>(messenger, store, pool,
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

/// Nanoseconds of a miss: rank 0 walks through the blocks of rank 1, of which the cache holds few.
template <class Store>
double TimeMisses(
  const Options& options, dsm::Messenger& messenger, Store& store, const dsm::BlockSegment& segment)
{
  const std::uint64_t words = options.BlockBytes / sizeof(std::uint64_t);
  const auto ranks = static_cast<std::uint64_t>(messenger.GetSize());
  const std::uint64_t blocks = segment.GetDirectory().GetCount() / ranks;
  rt::WorkerPool pool;
  double best = 1e300;
  for (int round = 0; round < options.Repeat; ++round)
  {
    double time = 0.0;
    RunFrame<Store>(messenger, store, pool,
      [&](typename Store::Worker& worker, int)
      {
        const auto start = Clock::now();
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
double TimeExchange(const Options& options, dsm::Messenger& messenger)
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
    const auto start = Clock::now();
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

struct Way
{
  const char* Name;
  dsm::MemoryOrganization Organization;
  bool HostSharing;
  bool PureFaulting;
};

constexpr Way Ways[] = {
  { "replicated", dsm::MemoryOrganization::Replicated, false, false },
  { "object", dsm::MemoryOrganization::ObjectBased, false, false },
  { "object, host shared", dsm::MemoryOrganization::ObjectBased, true, false },
  { "paged", dsm::MemoryOrganization::PageBased, false, false },
  { "paged, faults only", dsm::MemoryOrganization::PageBased, false, true },
};

dsm::BlockStore::Settings MakeSettings(const Way& way, int threads)
{
  dsm::BlockStore::Settings settings;
  settings.Organization = way.Organization;
  settings.HostSharing = way.HostSharing;
  settings.PureFaulting = way.PureFaulting;
  settings.Workers = threads;
  // Not to be cut short: what a hit costs is the question.
  settings.MemoryBytes = std::uint64_t(1) << 50;
  return settings;
}

void Print(std::ostream& out, const std::string& name, const HitCost& cost)
{
  out << "  " << std::left << std::setw(20) << name << std::right << std::fixed
      << std::setprecision(2) << std::setw(7) << cost.Store.Independent << std::setw(10)
      << cost.Array.Independent << std::setw(7) << cost.Store.Independent / cost.Array.Independent
      << std::setw(12) << cost.Store.Dependent << std::setw(7) << cost.Array.Dependent
      << std::setw(7) << cost.Store.Dependent / cost.Array.Dependent << '\n';
}

} // namespace

const char* AccessBenchmark::Usage()
{
  return "usage: dsm_bench access [options], alone or under mpirun\n"
         "  --sizes A[,B..]     MiB of data (default 128,1024)\n"
         "  --threads A[,B..]   tracing threads of rank 0, which reads (default 1,2)\n"
         "  --accesses N        hits of each thread in a round (default 2000000)\n"
         "  --misses N          misses (default 4000)\n"
         "  --block BYTES       a power of two (default 32768)\n"
         "  --repeat R          rounds, of which the fastest counts (default 5)\n"
         "  --json FILE         writes the result; - is standard output\n";
}

Options AccessBenchmark::Parse(int argc, char** argv)
{
  using namespace OptionValues;
  Options options;
  OptionValues::Parse(argc, argv,
    { { "--sizes",
        [&](const auto& name, const auto& text)
        { options.SizesMebibytes = ToNumbers<std::uint64_t>(name, text, 1); } },
      { "--threads",
        [&](const auto& name, const auto& text)
        { options.Threads = ToNumbers<int>(name, text, 1); } },
      { "--accesses",
        [&](const auto& name, const auto& text)
        { options.Accesses = ToNumber<std::uint64_t>(name, text, 1); } },
      { "--misses",
        [&](const auto& name, const auto& text)
        { options.Misses = ToNumber<std::uint64_t>(name, text, 1); } },
      { "--block",
        [&](const auto& name, const auto& text)
        {
          options.BlockBytes = ToNumber<std::uint32_t>(name, text, 4096);
          if ((options.BlockBytes & (options.BlockBytes - 1)) != 0)
          {
            throw dsm::Error(name + " takes a power of two, not " + text + ".");
          }
        } },
      { "--repeat",
        [&](const auto& name, const auto& text) { options.Repeat = ToNumber(name, text, 1); } },
      { "--json", [&](const auto&, const auto& text) { options.Json = text; } } },
    Usage());
  return options;
}

void AccessBenchmark::Run(const Options& options, dsm::Messenger& messenger)
{
  const bool speaks = messenger.GetRank() == 0;
  std::ostringstream table;
  Json hits = Json::array();
  Json misses = Json::object();
  for (const std::uint64_t mebibytes : options.SizesMebibytes)
  {
    const std::uint64_t bytes = mebibytes << 20;
    std::unique_ptr<RawArray> array;
    messenger.RunTogether("The raw array",
      [&]
      {
        if (speaks)
        {
          array = std::make_unique<RawArray>(bytes, options.BlockBytes);
        }
      });
    std::map<int, std::ostringstream> rows;
    for (const Way& way : Ways)
    {
      dsm::BlockStore store(messenger, MakeSettings(way, 1));
      const auto segment = PublishNumbers(messenger, store, bytes, options.BlockBytes);
      for (std::size_t i = 0; i < options.Threads.size(); ++i)
      {
        const int threads = options.Threads[i];
        store.SetSettings(MakeSettings(way, threads));
        const HitCost cost = store.Visit([&](auto& blocks)
          { return TimeHits(options, messenger, blocks, *segment, way.HostSharing, array.get()); });
        if (speaks)
        {
          Print(rows[threads], way.Name, cost);
          hits.push_back(
            { { "mebibytes", mebibytes }, { "threads", threads }, { "organization", way.Name },
              { "hit", ToJson(cost.Store) }, { "raw", ToJson(cost.Array) },
              { "ratio", cost.Store.Independent / cost.Array.Independent },
              { "dependent_ratio", cost.Store.Dependent / cost.Array.Dependent } });
        }
      }
      store.Retire(segment);
    }
    for (const auto& [threads, lines] : rows)
    {
      table << mebibytes << " MiB, " << threads << (threads > 1 ? " threads" : " thread")
            << ": ns/hit     array  ratio   dependent  array  ratio\n"
            << lines.str();
    }
  }
  if (messenger.GetSize() > 1)
  {
    const double exchange = TimeExchange(options, messenger);
    misses["exchange_us"] = 1e-3 * exchange;
    table << "a miss of " << options.BlockBytes << " bytes             us  ratio\n"
          << "  bare request and reply" << std::setw(9) << 1e-3 * exchange << '\n';
    for (const Way& way : Ways)
    {
      if (way.HostSharing || way.Organization == dsm::MemoryOrganization::Replicated)
      {
        continue;
      }
      dsm::BlockStore::Settings settings = MakeSettings(way, 1);
      settings.CacheBytes = std::size_t(8) * options.BlockBytes;
      dsm::BlockStore store(messenger, settings);
      const auto segment =
        PublishNumbers(messenger, store, options.SizesMebibytes.front() << 20, options.BlockBytes);
      const double miss =
        store.Visit([&](auto& blocks) { return TimeMisses(options, messenger, blocks, *segment); });
      misses[way.Name] = { { "us", 1e-3 * miss }, { "ratio", miss / exchange } };
      table << "  " << std::left << std::setw(22) << way.Name << std::right << std::setw(9)
            << 1e-3 * miss << std::setw(7) << miss / exchange << '\n';
    }
  }
  if (!speaks)
  {
    return;
  }
  const Json result = { { "ranks", messenger.GetSize() }, { "block_bytes", options.BlockBytes },
    { "hits", hits }, { "misses", misses } };
  if (options.Json == "-")
  {
    std::cout << result.dump(2) << std::endl;
    return;
  }
  if (!options.Json.empty())
  {
    std::ofstream(options.Json) << result.dump(2) << '\n';
  }
  std::cout << table.str() << std::flush;
}
