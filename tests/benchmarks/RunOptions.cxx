// SPDX-License-Identifier: BSD-3-Clause
#include "RunOptions.h"

#include <fstream>
#include <iostream>
#include <vector>

const std::map<std::string, dsm::MemoryOrganization>& RunOptions::GetStores()
{
  static const std::map<std::string, dsm::MemoryOrganization> stores{
    { "automatic", dsm::MemoryOrganization::Automatic },
    { "replicated", dsm::MemoryOrganization::Replicated },
    { "object", dsm::MemoryOrganization::ObjectBased },
    { "paged", dsm::MemoryOrganization::PageBased }
  };
  return stores;
}

void RunOptions::AddTo(CLI::App& app)
{
  app
    .add_option_function<std::vector<int>>(
      "--size",
      [this](const std::vector<int>& size)
      {
        this->Width = size.front();
        this->Height = size.back();
      },
      "pixels, WxH (default 512x512)")
    ->delimiter('x')
    ->allow_extra_args(false)
    ->check(CLI::PositiveNumber);
  app.add_option("--frames", this->Frames, "camera positions around the data")
    ->capture_default_str()
    ->check(CLI::PositiveNumber);
  app.add_option("--repeat", this->Repeat, "orbits; for every position the fastest counts")
    ->capture_default_str()
    ->check(CLI::PositiveNumber);
  app
    .add_option(
      "--threads", this->Threads, "tracing threads per rank; 0: cores / ranks of the host")
    ->capture_default_str()
    ->check(CLI::NonNegativeNumber);
  app.add_option("--store", this->Store, "default object")
    ->transform(CLI::CheckedTransformer(GetStores()));
  app.add_option("--host-sharing", this->HostSharing,
    "on: ranks of one host read one another's bricks in place; off (default): one machine plays "
    "many hosts, as the paper's figures need");
  app
    .add_option("--overlap", this->Overlap,
      "workers per thread: while some wait for bricks, others trace (default 4)")
    ->check(CLI::PositiveNumber);
  app.add_option("--prefetch", this->Prefetch,
    "off: bricks are asked for when rays come to them, none ahead (default on)");
  app.add_option("--scheduler", this->Scheduling, "rank 0 deals out tiles, or stealing (default)")
    ->transform(CLI::CheckedTransformer(
      std::map<std::string, rt::TileScheduling>{ { "queue", rt::TileScheduling::CentralQueue },
        { "stealing", rt::TileScheduling::WorkStealing } }));
  app.add_option("--latency", this->Latency, "microseconds that are added to every message's way")
    ->capture_default_str()
    ->check(CLI::NonNegativeNumber);
  app.add_option("--json", this->Json, "writes the result to a file; - is standard output");
}

dsm::BlockStore::Settings RunOptions::CreateSettings(dsm::Messenger& messenger) const
{
  dsm::BlockStore::Settings settings;
  settings.Organization = this->Store;
  settings.HostSharing = this->HostSharing;
  settings.Workers = this->Threads > 0 ? this->Threads : messenger.GetCoresPerRank();
  settings.Overlap = this->Overlap > 0 ? this->Overlap : settings.Overlap;
  settings.Prefetch = this->Prefetch;
  return settings;
}

void RunOptions::Write(const std::string& file, const std::string& result, const std::string& text)
{
  if (file == "-")
  {
    std::cout << result << std::endl;
    return;
  }
  if (!file.empty())
  {
    std::ofstream(file) << result << '\n';
  }
  std::cout << text << std::flush;
}
