// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TileTracer_h
#define rt_TileTracer_h

#include "DSMRayTracing/frame/BeamHistory.h"
#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/PixelTracer.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rt
{

/// Traces the pixels of a tile, one worker's view of one frame. With a BeamHistory, bricks that the
/// tile's beams will probably need are prefetched.
template <class Store>
class TileTracer
{
public:
  TileTracer(Store& store, typename Store::Worker& worker, const Scene& scene,
    const PixelRays& rays, const FrameRequest& request, BeamHistory* beams = nullptr)
    : Pixels(store, worker, scene, rays)
    , Request(request)
    , Beams(beams)
  {
  }

  /// Adds the request's samples to the tile's sums, which hold the samples before them. May wait for
  /// bricks.
  void Trace(Tile& tile) const
  {
    const std::size_t pixels = static_cast<std::size_t>(tile.Width) * tile.Height;
    if (this->Request.FirstSample == 0)
    {
      tile.Layers = this->Request.Layers;
      tile.Sum.assign(tile.Layers * pixels, glm::vec4(0.0f));
      tile.Depth.assign(tile.Layers * pixels, 1.0f);
    }
    tile.Color.resize(4 * tile.Layers * pixels);
    tile.Samples = this->Request.FirstSample + this->Request.Samples;
    VisitBeams(tile,
      [&](int left, int top, int width, int height)
      { this->TraceBeam(tile, left, top, width, height); });
  }

  /// Asks for the bricks that the tile will probably need, before it is traced by any worker. Returns
  /// whether any was absent. Never waits.
  bool Prefetch(const Tile& tile) const
  {
    bool anyAbsent = false;
    VisitBeams(tile,
      [&](int left, int top, int width, int height)
      {
        const int x = tile.X + left;
        const int y = tile.Y + top;
        anyAbsent |= this->Prefetch(this->Pixels.FindBricks(x, y, width, height), x, y);
      });
    return anyAbsent;
  }

  /// Makes pixels of the sums, in the colours of `tint`.
  void Finish(Tile& tile, const glm::vec3& tint) const
  {
    const std::size_t pixels = tile.Sum.size();
    const glm::vec4 scale =
      glm::vec4(tint, 1.0f) / float(this->Request.FirstSample + this->Request.Samples);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    {
      const glm::vec4 sum = tile.Sum[pixel];
      std::uint8_t* const color = &tile.Color[4 * pixel];
      if (sum == glm::vec4(0.0f))
      {
        std::fill_n(color, 4, std::uint8_t{ 0 });
        continue;
      }
      for (int channel = 0; channel < 4; ++channel)
      {
        const float value = std::clamp(scale[channel] * sum[channel], 0.0f, 1.0f);
        color[channel] = static_cast<std::uint8_t>(255.0f * value + 0.5f);
      }
    }
  }

private:
  static constexpr int BlockEdge = PixelTracer<Store>::BlockEdge;
  static constexpr int BoxEdge = PixelTracer<Store>::BoxEdge;
  /// Of the pixels that share the walk through the levels above the bricks. Fewer rays than that are
  /// traced at once, so that what is known of them stays in the nearest cache.
  static constexpr int BeamEdge = BeamHistory::Edge;

  /// Calls `visit(left, top, width, height)` for the parts of the tile's pixels that share a beam.
  template <class Visit>
  static void VisitBeams(const Tile& tile, const Visit& visit)
  {
    for (int top = 0; top < tile.Height; top += BeamEdge)
    {
      for (int left = 0; left < tile.Width; left += BeamEdge)
      {
        visit(
          left, top, std::min(BeamEdge, tile.Width - left), std::min(BeamEdge, tile.Height - top));
      }
    }
  }

  /// Adds the samples of a part of the tile's pixels.
  void TraceBeam(Tile& tile, int left, int top, int width, int height) const
  {
    const std::vector<BeamBricks> bricks =
      this->Pixels.FindBricks(tile.X + left, tile.Y + top, width, height);
    const bool usable = this->Pixels.AreUsable(bricks);
    const bool splits = !usable && (width > BlockEdge || height > BlockEdge);
    if (!this->Pixels.MayMeet(bricks))
    {
      this->Record(bricks, tile.X + left, tile.Y + top);
      return;
    }
    this->Prefetch(bricks, tile.X + left, tile.Y + top);
    const int edge = splits ? BlockEdge : BoxEdge;
    for (int j = 0; j < height; j += edge)
    {
      for (int i = 0; i < width; i += edge)
      {
        const int boxWidth = std::min(edge, width - i);
        const int boxHeight = std::min(edge, height - j);
        if (splits)
        {
          // Rays on both sides of where they run along an axis: fewer have more in common.
          this->TraceBeam(tile, left + i, top + j, boxWidth, boxHeight);
        }
        else
        {
          this->TraceBox(tile, bricks, left + i, top + j, boxWidth, boxHeight);
        }
      }
    }
    this->Record(bricks, tile.X + left, tile.Y + top);
  }

  /// For the beam at a pixel; returns whether any brick was absent.
  bool Prefetch(const std::vector<BeamBricks>& bricks, int x, int y) const
  {
    bool anyAbsent = false;
    for (std::size_t object = 0; this->Beams && object < bricks.size(); ++object)
    {
      anyAbsent |=
        this->Pixels.Prefetch(object, this->Beams->Predict(x, y, object, bricks[object]));
    }
    return anyAbsent;
  }

  void Record(const std::vector<BeamBricks>& bricks, int x, int y) const
  {
    for (std::size_t object = 0; this->Beams && object < bricks.size(); ++object)
    {
      if (bricks[object].Usable)
      {
        this->Beams->Record(x, y, object, bricks[object]);
      }
    }
  }

  void TraceBox(Tile& tile, const std::vector<BeamBricks>& bricks, int left, int top, int width,
    int height) const
  {
    for (int sample = 0; sample < this->Request.Samples; ++sample)
    {
      this->Pixels.TraceBox(bricks, tile.X + left, tile.Y + top, width, height,
        this->Request.FirstSample + sample,
        [&tile](int x, int y, const PixelSample& traced)
        {
          tile.LightRays += static_cast<std::uint64_t>(traced.LightRays);
          const std::size_t pixel = static_cast<std::size_t>(y - tile.Y) * tile.Width +
            static_cast<std::size_t>(x - tile.X);
          if (tile.Layers == 1)
          {
            tile.Sum[pixel] += traced.Color;
            // A pixel is as near as the nearest of its samples, so that a surface's antialiased
            // border still covers what is behind.
            tile.Depth[pixel] = std::min(tile.Depth[pixel], traced.Depth);
          }
          else
          {
            AddLayers(traced, pixel, tile);
          }
        });
    }
  }

  static void AddLayers(const PixelSample& traced, std::size_t pixel, Tile& tile)
  {
    const std::size_t pixels = static_cast<std::size_t>(tile.Width) * tile.Height;
    for (int layer = 0; layer < traced.Layers; ++layer)
    {
      const std::size_t place = pixels * std::min(layer, tile.Layers - 1) + pixel;
      tile.Sum[place] += traced.LayerColors[layer];
      tile.Depth[place] = std::min(tile.Depth[place], traced.LayerDepths[layer]);
    }
  }

  PixelTracer<Store> Pixels;
  const FrameRequest& Request;
  BeamHistory* Beams; ///< null: nothing is prefetched
};

} // namespace rt

#endif
