// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FrameRequest_h
#define rt_FrameRequest_h

#include "DSMRayTracing/frame/Channels.h"
#include "DSMRayTracing/schedule/TileScheduler.h"

#include <glm/mat4x4.hpp>

#include <memory>
#include <vector>

namespace rt
{

/// A picture to trace: the same on every rank.
struct FrameRequest
{
  /// Pixels; row 0 is the bottom row, as in OpenGL.
  int Width = 0;
  int Height = 0;
  /// World to clip space (OpenGL's: -1..1 on each axis after the division by w, near at z = -1) for
  /// the rectangle of Width x Height pixels; column vectors. Perspective, parallel, oblique alike.
  glm::dmat4 WorldToClip{ 1.0 };
  /// Pixels of the screen, along each axis, that a pixel of the picture is shown as: lines are as wide there.
  int PixelSize = 1;
  int TileSize = 16;
  /// Samples [FirstSample, FirstSample + Samples) of every pixel are averaged. Sample 0 is the
  /// pixel's center; the others are spread over the pixel.
  int FirstSample = 0;
  int Samples = 1;
  /// Standard error, of colors from 0 to 1, at which squares of pixels get no more samples (Tile::Counts); 0: all get
  /// them. Pictures of several layers have none.
  float Tolerance = 0.0f;
  /// They get so many first.
  static constexpr int SureSamples = 16;
  /// Surfaces that a pixel shows, front to back, which are kept apart; what is behind the last of them
  /// counts as part of it. More than one where something else is to be drawn between them.
  static constexpr int MaxLayers = 8;
  int Layers = 1;
  /// Window depth, in [0, 1], at which the rays of each pixel end, row by row from the bottom: where something
  /// opaque is that is not in the scene. Null: nowhere.
  std::shared_ptr<const std::vector<float>> Limits;
  /// Window depths at which media are cut into layers: where something translucent is that is not in the scene. As
  /// many pictures of Width x Height, one after the other, as there are in any pixel; from front to back, then 1.
  /// Null: nowhere.
  std::shared_ptr<const std::vector<float>> MediumCuts;
  /// Channels of each pixel of the image.
  ChannelSet Channels;
  TileScheduling Scheduling = TileScheduling::WorkStealing;
  /// The next picture may show the same surfaces from the same place: KeptHits.
  bool KeepsHits = false;

  /// Returns whether pixels may get fewer samples than others.
  bool MayStop() const { return this->Tolerance > 0.0f && this->Layers == 1; }
};

} // namespace rt

#endif
