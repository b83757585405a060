// SPDX-License-Identifier: BSD-3-Clause
#ifndef AccessBenchmark_h
#define AccessBenchmark_h

#include "DSMCore/transport/Messenger.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <vector>

/// The paper's Table 1: what a hit and a miss cost, in every organization, against a raw array and a
/// bare exchange of messages. Rank 0 reads, the others serve.
class AccessBenchmark
{
public:
  struct Options
  {
    std::vector<std::uint64_t> SizesMebibytes{ 128, 1024 };
    std::vector<int> Threads{ 1, 2 };
    std::uint64_t Accesses = 2000000; ///< hits of each thread in a round
    std::uint64_t Misses = 4000;
    std::uint32_t BlockBytes = 32768; ///< a power of two
    int Repeat = 5;                   ///< rounds, of which the fastest counts
    std::string Json;                 ///< file, or - for standard output; empty: none

    /// Adds the options that change this object.
    void AddTo(CLI::App& app);
  };

  /// Collective. Prints on rank 0.
  static void Run(const Options& options, dsm::Messenger& messenger);
};

#endif
