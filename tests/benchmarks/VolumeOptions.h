// SPDX-License-Identifier: BSD-3-Clause
#ifndef VolumeOptions_h
#define VolumeOptions_h

#include "RunOptions.h"

#include "DSMRayTracing/frame/FrameRequest.h"

#include <cstdint>
#include <string>

/// What the benchmarks that trace a volume are told.
struct VolumeOptions : RunOptions
{
  std::string Volume = "sphere:128:float";
  double CacheFraction = 1.0;  ///< of the bytes of all bricks
  std::uint64_t Mebibytes = 0; ///< of memory per rank; 0: a part of what the host has
  int BrickEdge = 0;           ///< cells; 0: the default of the scalar type
  int TileSize = rt::FrameRequest().TileSize;
  bool Shadows = false; ///< of a lamp beside the camera
  double LightRadius = 0.0;
  int Occlusion = 0;      ///< ambient occlusion rays for each place that is lit
  int Samples = 1;        ///< per pixel
  double Tolerance = 0.0; ///< FrameRequest::Tolerance, in steps of 255
  std::string Session;    ///< file; empty: an orbit
  std::string Picture;    ///< PPM file of the first frame; empty: none

  /// Adds the options that change this object.
  void AddTo(CLI::App& app);
};

#endif
