// SPDX-License-Identifier: BSD-3-Clause
#include "RunOptions.h"

#include <fstream>
#include <iostream>

void RunOptions::AddTo(OptionValues::Setters& setters)
{
  using namespace OptionValues;
  setters.merge(Setters{
    { "--size",
      [this](const auto& name, const auto& text)
      {
        const auto x = text.find('x');
        this->Width = ToNumber(name, text.substr(0, x), 1);
        this->Height = ToNumber(name, x == std::string::npos ? "" : text.substr(x + 1), 1);
      } },
    { "--frames",
      [this](const auto& name, const auto& text) { this->Frames = ToNumber(name, text, 1); } },
    { "--repeat",
      [this](const auto& name, const auto& text) { this->Repeat = ToNumber(name, text, 1); } },
    { "--threads",
      [this](const auto& name, const auto& text) { this->Threads = ToNumber(name, text, 0); } },
    { "--store",
      [this](const auto& name, const auto& text)
      {
        this->Store = ToChoice<dsm::MemoryOrganization>(name, text,
          { { "automatic", dsm::MemoryOrganization::Automatic },
            { "replicated", dsm::MemoryOrganization::Replicated },
            { "object", dsm::MemoryOrganization::ObjectBased },
            { "paged", dsm::MemoryOrganization::PageBased } });
      } },
    { "--host-sharing",
      [this](const auto& name, const auto& text) { this->HostSharing = ToSwitch(name, text); } },
    { "--overlap",
      [this](const auto& name, const auto& text) { this->Overlap = ToNumber(name, text, 1); } },
    { "--prefetch",
      [this](const auto& name, const auto& text) { this->Prefetch = ToSwitch(name, text); } },
    { "--scheduler",
      [this](const auto& name, const auto& text)
      {
        this->Scheduling = ToChoice<rt::TileScheduling>(name, text,
          { { "queue", rt::TileScheduling::CentralQueue },
            { "stealing", rt::TileScheduling::WorkStealing } });
      } },
    { "--latency",
      [this](const auto& name, const auto& text)
      { this->Latency = 1e-6 * ToNumber<double>(name, text, 0.0); } },
    { "--json", [this](const auto&, const auto& text) { this->Json = text; } },
  });
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
