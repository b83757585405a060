// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileTracer_h
#define rt_TileTracer_h

#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/PixelTracer.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

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
    for (int top = 0; top < tile.Height; top += BoxEdge)
    {
      for (int left = 0; left < tile.Width; left += BoxEdge)
      {
        this->TraceBox(tile, left, top, std::min(BoxEdge, tile.Width - left),
          std::min(BoxEdge, tile.Height - top));
      }
    }
    const float scale = 1.0f / (this->Request.FirstSample + this->Request.Samples);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    {
      const glm::vec4 color = scale * tile.Sum[pixel];
      for (int channel = 0; channel < 4; ++channel)
      {
        tile.Color[4 * pixel + channel] =
          static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(color[channel], 0.0f, 1.0f)));
      }
    }
  }

private:
  static constexpr int BlockEdge = PixelTracer<Store>::BlockEdge;
  static constexpr int BoxEdge = PixelTracer<Store>::BoxEdge;

  /// Adds the samples of a box of the tile's pixels.
  void TraceBox(Tile& tile, int left, int top, int width, int height) const
  {
    const std::vector<BeamBricks> bricks =
      this->Pixels.FindBricks(tile.X + left, tile.Y + top, width, height);
    if (!this->Pixels.AreUsable(bricks) && (width > BlockEdge || height > BlockEdge))
    {
      // Rays on both sides of where they run along an axis: fewer of them have more in common.
      for (int j = 0; j < height; j += BlockEdge)
      {
        for (int i = 0; i < width; i += BlockEdge)
        {
          this->TraceBox(tile, left + i, top + j, std::min(BlockEdge, width - i),
            std::min(BlockEdge, height - j));
        }
      }
      return;
    }
    for (int sample = 0; sample < this->Request.Samples; ++sample)
    {
      this->Pixels.TraceBox(bricks, tile.X + left, tile.Y + top, width, height,
        this->Request.FirstSample + sample,
        [&](int i, int j, const PixelSample& traced)
        {
          const std::size_t pixel =
            static_cast<std::size_t>(top + j) * tile.Width + static_cast<std::size_t>(left + i);
          tile.Sum[pixel] += traced.Color;
          // A pixel is as near as the nearest of its samples, so that a surface's antialiased
          // border still covers what is behind.
          tile.Depth[pixel] = std::min(tile.Depth[pixel], traced.Depth);
        });
    }
  }

  PixelTracer<Store> Pixels;
  const FrameRequest& Request;
};

} // namespace rt

#endif
