// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PixelSample_h
#define rt_PixelSample_h

#include "DSMRayTracing/frame/FrameRequest.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstdint>

namespace rt
{

/// Color, premultiplied, and window depth of what a sample of a pixel shows.
struct PixelSample
{
  static constexpr int MaxLayers = FrameRequest::MaxLayers;

  glm::ivec2 Pixel{ 0 };
  glm::vec4 Color{ 0.0f };
  /// Depth of the nearest surface, or of the position in media in front of it where half of the
  /// final coverage is reached.
  float Depth = 1.0f;
  int LightRays = 0; ///< shadow and occlusion rays that were traced for it

  /// Channels on request, set where any was asked for: see Channels.
  glm::vec4 Albedo{ 0.0f };
  glm::vec3 Normal{ 0.0f };
  glm::vec3 Open{ 0.0f }; ///< Color, if nothing stopped those light rays that have noise
  std::int32_t Object = -1;
  float Integral = 0.0f; ///< of sample 0

  /// The same surface by surface, front to back: its depth, and what it contributes to the color.
  /// Where there are more surfaces than layers, a layer stands for several: see AddLayer.
  int Layers = 0;
  float LayerDepths[MaxLayers];
  glm::vec4 LayerColors[MaxLayers];

  /// Surfaces must be added front to back. If all layers are full, two neighbors become one: those that change
  /// least what is drawn between them. The one that contributes less moves to the depth of the other (as nodes of
  /// the visibility function in Salvi, Montgomery, Lefohn, Adaptive Transparency, 2011). `isMedium`: a surface
  /// behind it that is better seen gives the sample its depth.
  void AddLayer(const glm::vec4& color, float depth, bool isMedium = false)
  {
    const bool isNearest = this->Layers == 0;
    this->Cover += color.w;
    if (this->Layers == MaxLayers)
    {
      this->AddMerged(color, depth);
      return;
    }
    this->Depth = isNearest || (this->IsFaint && this->Cover >= 0.5f) ? depth : this->Depth;
    this->IsFaint = this->Cover < 0.5f && (isNearest ? isMedium : this->IsFaint);
    this->LayerColors[this->Layers] = color;
    this->LayerDepths[this->Layers++] = depth;
  }

private:
  void AddMerged(const glm::vec4& color, float depth)
  {
    const auto getColor = [&](int layer) -> const glm::vec4&
    { return layer < MaxLayers ? this->LayerColors[layer] : color; };
    const auto getDepth = [&](int layer)
    { return layer < MaxLayers ? this->LayerDepths[layer] : depth; };
    const auto getDifference = [&](int layer)
    {
      return (getDepth(layer + 1) - getDepth(layer)) *
        std::min(getColor(layer).w, getColor(layer + 1).w);
    };
    int best = MaxLayers - 1;
    for (int layer = MaxLayers - 2; layer >= 0; --layer)
    {
      best = getDifference(layer) < getDifference(best) ? layer : best;
    }
    if (getColor(best + 1).w > getColor(best).w)
    {
      this->LayerDepths[best] = getDepth(best + 1);
    }
    this->LayerColors[best] += getColor(best + 1);
    for (int layer = best + 1; layer < MaxLayers; ++layer)
    {
      this->LayerColors[layer] = getColor(layer + 1);
      this->LayerDepths[layer] = getDepth(layer + 1);
    }
  }

  float Cover = 0.0f;   ///< by all layers
  bool IsFaint = false; ///< Depth is that of a medium that covers less than half
};

} // namespace rt

#endif
