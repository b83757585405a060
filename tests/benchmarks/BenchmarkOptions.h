// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkOptions_h
#define BenchmarkOptions_h

#include "VolumeOptions.h"

#include <vector>

/// What `dsm_bench isosurface` was asked to do.
struct BenchmarkOptions : VolumeOptions
{
  std::vector<double> Isovalues{ 0.5 };
  float Opacity = 1.0f;     ///< of the surfaces
  bool TileSeconds = false; ///< the result has those of the tiles
  bool Looks =
    false; ///< compares pictures in other colors and light with those whose rays are traced
  bool Filter = false; ///< compares a filtered picture of one sample with those of many

  /// Adds the options that change this object.
  void AddTo(CLI::App& app);
};

#endif
