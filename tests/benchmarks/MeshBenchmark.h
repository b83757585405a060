// SPDX-License-Identifier: BSD-3-Clause
#ifndef MeshBenchmark_h
#define MeshBenchmark_h

#include "BenchmarkMesh.h"
#include "RunOptions.h"

#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <string>
#include <vector>

/// Frames of a mesh out of shared bricks: the paper's Figure 8 (frame rate and misses by the size of
/// the cache, for three orders of the triangles), bytes for each triangle, and, on one rank where
/// Embree is there, building, packets and single rays beside it in the same run.
class MeshBenchmark
{
public:
  struct Options : RunOptions
  {
    Options()
    {
      this->Frames = 8;
      this->Repeat = 3;
    }

    std::string Mesh = "grid:708";
    int Subdivisions = 0;
    std::vector<BenchmarkMesh::Order> Orders{ BenchmarkMesh::Order::Sorted };
    std::vector<double> CacheFractions{ 1.0 }; ///< of the bytes of all bricks
    double Arc = 360.0;                        ///< degrees of the way around the mesh

    /// Adds the options that change this object.
    void AddTo(CLI::App& app);
  };

  /// Collective. Prints on rank 0.
  static void Run(const Options& options, dsm::Messenger& messenger);
};

#endif
