// SPDX-License-Identifier: BSD-3-Clause
#include "AccessBenchmark.h"

#include "HitTiming.h"
#include "MissTiming.h"
#include "RunOptions.h"

#include "DSMCore/store/BlockStore.h"

#include <nlohmann/json.hpp>

#include <iomanip>
#include <map>
#include <sstream>

namespace
{

using namespace AccessTiming;
using Json = nlohmann::ordered_json;
using Options = AccessBenchmark::Options;

Json ToJson(const Cost& cost)
{
  return { { "independent_ns", cost.Independent }, { "dependent_ns", cost.Dependent } };
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
  settings.Overlap = 1;
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

void AccessBenchmark::Options::AddTo(CLI::App& app)
{
  app.add_option("--sizes", this->SizesMebibytes, "MiB of data, with commas (default 128,1024)")
    ->delimiter(',')
    ->allow_extra_args(false)
    ->check(CLI::PositiveNumber);
  app
    .add_option("--threads", this->Threads,
      "tracing threads of rank 0, which reads, with commas (default 1,2)")
    ->delimiter(',')
    ->allow_extra_args(false)
    ->check(CLI::PositiveNumber);
  app.add_option("--accesses", this->Accesses, "hits of each thread in a round")
    ->capture_default_str()
    ->check(CLI::PositiveNumber);
  app.add_option("--misses", this->Misses, "misses")
    ->capture_default_str()
    ->check(CLI::PositiveNumber);
  app.add_option("--block", this->BlockBytes, "bytes of a block")
    ->capture_default_str()
    ->check(CLI::Range(4096, 1 << 30))
    ->check(
      [](const std::string& text)
      {
        const unsigned long bytes = std::stoul(text);
        return std::string((bytes & (bytes - 1)) != 0 ? "is no power of two" : "");
      });
  app.add_option("--repeat", this->Repeat, "rounds, of which the fastest counts")
    ->capture_default_str()
    ->check(CLI::PositiveNumber);
  app.add_option("--json", this->Json, "writes the result to a file; - is standard output");
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
    table << std::fixed << std::setprecision(2) << "a miss of " << options.BlockBytes
          << " bytes         us  ratio\n"
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
  RunOptions::Write(options.Json, result.dump(2), table.str());
}
