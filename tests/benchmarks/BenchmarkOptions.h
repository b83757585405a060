// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkOptions_h
#define BenchmarkOptions_h

#include "RunOptions.h"

#include "DSMRayTracing/frame/FrameRequest.h"

#include <cstdint>
#include <string>
#include <vector>

/// What `dsm_bench isosurface` was asked to do.
struct BenchmarkOptions : RunOptions
{
  std::string Volume = "sphere:128:float";
  std::vector<double> Isovalues{ 0.5 };
  std::vector<double>
    Medium; ///< first and last value, and opacity of a cell at the last; empty: isosurfaces
  double CacheFraction = 1.0;  ///< of the bytes of all bricks
  std::uint64_t Mebibytes = 0; ///< of memory per rank; 0: a part of what the host has
  int BrickEdge = 0;           ///< cells; 0: the default of the scalar type
  int TileSize = rt::FrameRequest().TileSize;
  bool Shadows = false;     ///< of a lamp beside the camera
  int Occlusion = 0;        ///< ambient occlusion rays for each hit
  float Opacity = 1.0f;     ///< of the surfaces
  int Samples = 1;          ///< per pixel
  std::string Session;      ///< file; empty: an orbit
  bool TileSeconds = false; ///< the result has those of the tiles
  std::string Picture;      ///< PPM file of the first frame; empty: none

  /// Adds the options that change this object.
  void AddTo(CLI::App& app);
};

#endif
