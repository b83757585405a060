// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PixelSample_h
#define rt_PixelSample_h

#include "DSMRayTracing/frame/FrameRequest.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>

namespace rt
{

/// Color, premultiplied, and window depth of what a sample of a pixel shows.
struct PixelSample
{
  static constexpr int MaxLayers = FrameRequest::MaxLayers;

  glm::ivec2 Pixel{ 0 };
  glm::vec4 Color{ 0.0f };
  glm::vec3 Shared{ 0.0f }; ///< light that neighbors' ambient occlusion adds to Color in previews
  /// Depth of the nearest surface, or of the position in media in front of it where half of the
  /// final coverage is reached.
  float Depth = 1.0f;
  int LightRays = 0; ///< shadow and occlusion rays that were traced for it

  /// Channels on request, set where any was asked for: see Channels.
  glm::vec4 Albedo{ 0.0f };
  glm::vec3 Normal{ 0.0f };
  std::int32_t Object = -1;

  /// The same surface by surface, front to back: its depth, and what it contributes to the color.
  /// The last one stands for all behind it.
  int Layers = 0;
  float LayerDepths[MaxLayers];
  glm::vec4 LayerColors[MaxLayers];

  /// `isMedium`: a surface behind it that is better seen gives the sample its depth.
  void AddLayer(const glm::vec4& color, float depth, bool isMedium = false)
  {
    const bool isNearest = this->Layers == 0;
    this->Cover += color.w;
    if (this->Layers == MaxLayers)
    {
      this->LayerColors[MaxLayers - 1] += color;
      return;
    }
    this->Depth = isNearest || (this->IsFaint && this->Cover >= 0.5f) ? depth : this->Depth;
    this->IsFaint = this->Cover < 0.5f && (isNearest ? isMedium : this->IsFaint);
    this->LayerColors[this->Layers] = color;
    this->LayerDepths[this->Layers++] = depth;
  }

private:
  float Cover = 0.0f;   ///< by all layers
  bool IsFaint = false; ///< Depth is that of a medium that covers less than half
};

} // namespace rt

#endif
