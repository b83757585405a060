// SPDX-License-Identifier: BSD-3-Clause
#ifndef RunOptions_h
#define RunOptions_h

#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/schedule/TileScheduler.h"

#include <CLI/CLI.hpp>

#include <map>
#include <string>

/// What all benchmarks that trace frames are told.
struct RunOptions
{
  int Width = 512;
  int Height = 512;
  int Frames = 20;
  int Repeat = 1;
  int Threads = 0; ///< 0: the host's cores divided by its ranks
  dsm::MemoryOrganization Store = dsm::MemoryOrganization::ObjectBased;
  bool HostSharing = false; ///< off: one machine plays many hosts
  int Overlap = 0;          ///< workers per thread; 0: the store's default
  bool Prefetch = true;     ///< of bricks that tiles will probably need
  rt::TileScheduling Scheduling = rt::TileScheduling::WorkStealing;
  double Latency = 0.0; ///< microseconds that are added to every message's way
  std::string Json;     ///< file, or - for standard output; empty: none

  static const std::map<std::string, dsm::MemoryOrganization>& GetStores();

  /// Adds the options that change this object.
  void AddTo(CLI::App& app);

  /// How the store is to be set up. Collective the first time.
  dsm::BlockStore::Settings CreateSettings(dsm::Messenger& messenger) const;

  /// Writes a result to a file and the text about it to standard output; with - only the result, there.
  static void Write(const std::string& file, const std::string& result, const std::string& text);
};

#endif
