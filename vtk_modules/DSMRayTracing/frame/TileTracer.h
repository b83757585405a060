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
    const std::vector<BeamBricks> bricks =
      this->Pixels.FindBricks(tile.X, tile.Y, tile.Width, tile.Height);
    if (this->Pixels.MayMeet(bricks))
    {
      for (int sample = 0; sample < this->Request.Samples; ++sample)
      {
        this->AddSample(tile, bricks, this->Request.FirstSample + sample);
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

  /// One sample of each pixel.
  void AddSample(Tile& tile, const std::vector<BeamBricks>& bricks, int sample) const
  {
    PixelSample traced[RayPacket::Size];
    for (int top = 0; top < tile.Height; top += BlockEdge)
    {
      for (int left = 0; left < tile.Width; left += BlockEdge)
      {
        const int width = std::min(BlockEdge, tile.Width - left);
        const int height = std::min(BlockEdge, tile.Height - top);
        this->Pixels.TraceBlock(
          bricks, tile.X + left, tile.Y + top, width, height, sample, traced);
        for (int j = 0; j < height; ++j)
        {
          for (int i = 0; i < width; ++i)
          {
            const PixelSample& from = traced[i + BlockEdge * j];
            const std::size_t pixel =
              static_cast<std::size_t>(top + j) * tile.Width + static_cast<std::size_t>(left + i);
            tile.Sum[pixel] += from.Color;
            // A pixel is as near as the nearest of its samples, so that a surface's antialiased
            // border still covers what is behind.
            tile.Depth[pixel] = std::min(tile.Depth[pixel], from.Depth);
          }
        }
      }
    }
  }

  PixelTracer<Store> Pixels;
  const FrameRequest& Request;
};

} // namespace rt

#endif
