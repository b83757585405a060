// SPDX-License-Identifier: BSD-3-Clause
#ifndef ConsolidationBenchmark_h
#define ConsolidationBenchmark_h

#include "BenchmarkOptions.h"

#include "DSMCore/transport/Messenger.h"

#include <string>
#include <vector>

/// The paper's Table 2: what it costs, in accesses and frames, to acquire a brick for every sample, for
/// every cell, or once while a ray is in it. Rays one by one, tiles dealt out in turn.
class ConsolidationBenchmark
{
public:
  struct Options : BenchmarkOptions
  {
    std::vector<std::string> Patterns{ "one", "eight", "many" };

    /// Adds the options that change this object.
    void AddTo(CLI::App& app);
  };

  /// Collective. Prints on rank 0.
  static void Run(const Options& options, dsm::Messenger& messenger);
};

#endif
