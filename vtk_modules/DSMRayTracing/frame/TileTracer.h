// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileTracer_h
#define rt_TileTracer_h

#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/PixelTracer.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rt
{

/// Traces the pixels of a tile, one worker's view of one frame.
template <class Store>
class TileTracer
{
public:
  TileTracer(Store& store, typename Store::Worker& worker, const Scene& scene,
    const PixelRays& rays, const FrameRequest& request)
    : Pixels(store, worker, scene, rays)
    , Request(request)
  {
  }

  /// Adds the request's samples to the tile's sums (which must hold the samples before them) and
  /// makes its pixels of them. May wait for bricks.
  void Trace(Tile& tile) const
  {
    const std::size_t pixels = static_cast<std::size_t>(tile.Width) * tile.Height;
    tile.Color.resize(4 * pixels);
    if (this->Request.FirstSample == 0)
    {
      tile.Sum.assign(pixels, glm::vec4(0.0f));
      tile.Depth.assign(pixels, 1.0f);
    }
    const float scale = 1.0f / (this->Request.FirstSample + this->Request.Samples);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    {
      this->AddSamples(tile, pixel);
      const glm::vec4 color = scale * tile.Sum[pixel];
      for (int channel = 0; channel < 4; ++channel)
      {
        tile.Color[4 * pixel + channel] =
          static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(color[channel], 0.0f, 1.0f)));
      }
    }
  }

private:
  void AddSamples(Tile& tile, std::size_t pixel) const
  {
    const int x = tile.X + static_cast<int>(pixel % tile.Width);
    const int y = tile.Y + static_cast<int>(pixel / tile.Width);
    for (int sample = 0; sample < this->Request.Samples; ++sample)
    {
      const PixelSample traced = this->Pixels.Trace(x, y, this->Request.FirstSample + sample);
      tile.Sum[pixel] += traced.Color;
      // A pixel is as near as the nearest of its samples, so that a surface's antialiased border
      // still covers what is behind.
      tile.Depth[pixel] = std::min(tile.Depth[pixel], traced.Depth);
    }
  }

  PixelTracer<Store> Pixels;
  const FrameRequest& Request;
};

} // namespace rt

#endif
