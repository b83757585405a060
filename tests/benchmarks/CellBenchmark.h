// SPDX-License-Identifier: BSD-3-Clause
#ifndef CellBenchmark_h
#define CellBenchmark_h

#include "RunOptions.h"

#include "DSMCore/transport/Messenger.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <vector>

/// Frames of cells: what they take in memory, how long they are built, and how fast they are traced.
class CellBenchmark
{
public:
  struct Options : RunOptions
  {
    Options() { this->Frames = 4; }

    std::vector<std::string> Kinds{ "tetrahedra" }; ///< hexahedra, mixed, grid
    std::uint64_t Cells = 1000000;                  ///< about
    std::vector<std::string> Shows{ "surface" };    ///< fog, shell, ramp
    double Isovalue = 0.5;
    bool Gradients = true;
    std::string Picture; ///< file.ppm of the first position

    /// Adds the options that change this object.
    void AddTo(CLI::App& app);
  };

  /// Collective. Prints on rank 0.
  static void Run(const Options& options, dsm::Messenger& messenger);
};

#endif
