// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkOptions_h
#define BenchmarkOptions_h

#include "DSMCore/MemoryOrganization.h"

#include <cstdint>
#include <string>
#include <vector>

/// What `dsm_bench isosurface` was asked to do; see Usage.
struct BenchmarkOptions
{
  std::string Volume = "sphere:128:float";
  std::vector<double> Isovalues{ 0.5 };
  int Width = 512;
  int Height = 512;
  int Frames = 20;
  int Repeat = 1;
  int Threads = 0; ///< 0: the host's cores divided by its ranks
  dsm::MemoryOrganization Store = dsm::MemoryOrganization::ObjectBased;
  double CacheFraction = 1.0;    ///< of the bytes of all bricks
  bool HostSharing = false;      ///< off: one machine plays many hosts
  std::uint64_t MemoryBytes = 0; ///< per rank; 0: a part of what the host has
  int BrickEdge = 0;             ///< cells; 0: the default of the scalar type
  std::string Json;              ///< file, or - for standard output; empty: none
  std::string Picture;           ///< PPM file of the first frame; empty: none

  static const char* Usage();

  /// Throws dsm::Error naming the argument that is wrong.
  static BenchmarkOptions Parse(int argc, char** argv);
};

#endif
