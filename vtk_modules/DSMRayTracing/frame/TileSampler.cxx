// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/TileSampler.h"

#include "DSMRayTracing/look/PackedColor.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace rt
{

namespace
{

/// Edge of the square of pixels that share the walk through the levels above the bricks. Smaller
/// blocks of rays are traced together, so that their data stay in the nearest cache.
constexpr int BeamEdge = BeamHistory::Edge;
constexpr int SmallestBeamEdge = PixelSampler::BlockEdge;

/// Four bytes of a sum of samples. Called, it costs frames 0.5 %.
[[gnu::always_inline]] inline void ConvertSum(
  const glm::vec4& sum, const glm::vec4& scale, std::uint8_t* color)
{
  for (int channel = 0; channel < 4; ++channel)
  {
    color[channel] = PackedColor::ToByte(scale[channel] * sum[channel]);
  }
}

/// The place of a sample's pixel in its tile.
std::size_t GetPixel(const PixelSample& traced, const Tile& tile)
{
  return static_cast<std::size_t>(traced.Pixel.y - tile.Y) * tile.Width +
    static_cast<std::size_t>(traced.Pixel.x - tile.X);
}

/// Adds a sample of that number to the channels on request that the tile has.
void AddMoreChannels(const PixelSample& traced, int sample, Tile& tile)
{
  const std::size_t pixel = GetPixel(traced, tile);
  if (tile.Present.Has(ChannelSet::Albedo))
  {
    tile.AlbedoSum[pixel] += traced.Albedo;
  }
  if (tile.Present.Has(ChannelSet::Normal))
  {
    tile.NormalSum[pixel] += traced.Normal;
  }
  if (tile.Present.Has(ChannelSet::Light))
  {
    const float open = traced.Open.x + traced.Open.y + traced.Open.z;
    const float part =
      open > 0.0f ? (traced.Color.x + traced.Color.y + traced.Color.z) / open : 1.0f;
    tile.OpenSum[pixel] += traced.Open;
    tile.ArrivingSquares[pixel] += part * part;
    if (sample == 0 && traced.Normal != glm::vec3(0.0f))
    {
      tile.Normals[pixel] = PackedNormal(traced.Normal);
    }
  }
  if (tile.Present.Has(ChannelSet::Object) && sample == 0)
  {
    tile.Object[pixel] = traced.Object;
  }
  if (tile.Present.Has(ChannelSet::Integral) && sample == 0)
  {
    tile.Integral[pixel] = traced.Integral;
  }
}

} // namespace

TileSampler::TileSampler(const SceneTracers& tracers, const Scene& scene, const PixelRays& rays,
  const FrameRequest& request, BeamHistory* beams, KeptHits* hits)
  : Finders(tracers.GetBeamFinders())
  , Pixels(tracers, scene, rays, request.Channels)
  , Request(request)
  , Beams(beams)
  , Hits(hits)
{
}

template <class Visit>
void TileSampler::Split(const PixelBox& whole, int edge, const Visit& visit)
{
  for (int top = 0; top < whole.Height; top += edge)
  {
    for (int left = 0; left < whole.Width; left += edge)
    {
      visit(PixelBox{ whole.Left + left, whole.Top + top, std::min(edge, whole.Width - left),
        std::min(edge, whole.Height - top) });
    }
  }
}

void TileSampler::Trace(Tile& tile) const
{
  const std::size_t pixels = static_cast<std::size_t>(tile.Width) * tile.Height;
  if (this->Request.FirstSample == 0)
  {
    tile.Layers = this->Request.Layers;
    tile.Reset(this->Request.Channels, tile.Layers * pixels);
    tile.Sum.assign(tile.Layers * pixels, glm::vec4(0.0f));
    tile.AlbedoSum.assign(tile.Present.Has(ChannelSet::Albedo) ? pixels : 0, glm::vec4(0.0f));
    const bool isForFilter = tile.Present.Has(ChannelSet::Light);
    tile.NormalSum.assign(tile.Present.Has(ChannelSet::Normal) ? pixels : 0, glm::vec3(0.0f));
    tile.OpenSum.assign(isForFilter ? pixels : 0, glm::vec3(0.0f));
    tile.ArrivingSquares.assign(isForFilter ? pixels : 0, 0.0f);
    tile.Normals.assign(isForFilter ? pixels : 0, PackedNormal());
    tile.Counts.assign(this->Request.MayStop() ? pixels : 0, 0);
    tile.Squares.assign(this->Request.MayStop() ? pixels : 0, 0.0f);
  }
  tile.Samples = this->Request.FirstSample + this->Request.Samples;
  FirstHits hits = this->FindFirstHits(tile);
  const PixelBox whole{ 0, 0, tile.Width, tile.Height };
  if (hits.AreKnown && !this->Pixels.LooksBehindHits())
  {
    Split(whole, PixelSampler::BoxEdge,
      [&](const PixelBox& box) { this->TraceBatch(tile, nullptr, box, hits); });
    return;
  }
  Split(whole, BeamEdge, [&](const PixelBox& box) { this->TraceBeam(tile, box, hits); });
  if (this->Hits)
  {
    this->Hits->Keep(tile.Index, std::move(hits.Kept));
  }
}

TileSampler::FirstHits TileSampler::FindFirstHits(const Tile& tile) const
{
  FirstHits hits;
  if (!this->Hits)
  {
    return hits;
  }
  const int known = this->Hits->CountKnown(tile.Index);
  const std::size_t pixels = static_cast<std::size_t>(tile.Width) * tile.Height;
  const int end = this->Request.FirstSample + this->Request.Samples;
  for (int sample = this->Request.FirstSample; sample < end; ++sample)
  {
    if (sample < known)
    {
      hits.Known.push_back(&this->Hits->Get(tile.Index, sample));
    }
    else if (sample == known + static_cast<int>(hits.Kept.size()) && this->Hits->HasRoom(sample))
    {
      hits.Kept.emplace_back(pixels);
    }
  }
  hits.AreKnown = static_cast<int>(hits.Known.size()) == this->Request.Samples;
  return hits;
}

bool TileSampler::Prefetch(const Tile& tile) const
{
  bool anyAbsent = false;
  if (this->Hits &&
    this->Hits->CountKnown(tile.Index) >= this->Request.FirstSample + this->Request.Samples)
  {
    return anyAbsent;
  }
  Split({ 0, 0, tile.Width, tile.Height }, BeamEdge,
    [&](const PixelBox& box) {
      anyAbsent |= this->IsOpen(tile, box) && this->Prefetch(this->FindBeam(tile, box), tile, box);
    });
  return anyAbsent;
}

void TileSampler::Finish(Tile& tile, const glm::vec3& tint) const
{
  const std::size_t pixels = tile.Sum.size();
  const auto samples = static_cast<float>(this->Request.FirstSample + this->Request.Samples);
  glm::vec4 scale = glm::vec4(tint, 1.0f) / samples;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
  {
    const glm::vec4& sum = tile.Sum[pixel];
    std::uint8_t* const color = &tile.Color[4 * pixel];
    if (sum == glm::vec4(0.0f))
    {
      std::fill_n(color, 4, std::uint8_t{ 0 });
      continue;
    }
    if (!tile.Counts.empty())
    {
      scale = glm::vec4(tint, 1.0f) / static_cast<float>(tile.Counts[pixel]);
    }
    ConvertSum(sum, scale, color);
  }
  for (std::size_t pixel = 0; pixel < tile.AlbedoSum.size(); ++pixel)
  {
    const auto count = static_cast<float>(tile.CountSamples(pixel));
    ConvertSum(tile.AlbedoSum[pixel], glm::vec4(1.0f / count), &tile.Albedo[4 * pixel]);
  }
  for (std::size_t pixel = 0; pixel < tile.NormalSum.size(); ++pixel)
  {
    const float length = glm::length(tile.NormalSum[pixel]);
    for (int axis = 0; axis < 3; ++axis)
    {
      tile.Normal[3 * pixel + axis] = length > 0.0f ? tile.NormalSum[pixel][axis] / length : 0.0f;
    }
  }
}

SceneBeam TileSampler::FindBeam(const Tile& tile, const PixelBox& box) const
{
  return this->Pixels.FindBeam(tile.X + box.Left, tile.Y + box.Top, box.Width, box.Height);
}

/// Returns whether any brick was absent.
bool TileSampler::Prefetch(const SceneBeam& beam, const Tile& tile, const PixelBox& box) const
{
  bool anyAbsent = false;
  for (std::size_t object = 0; this->Beams && object < beam.Objects.size(); ++object)
  {
    if (beam.Objects[object])
    {
      anyAbsent |= this->Finders[object]->Prefetch(
        *beam.Objects[object], this->Beams->Predict(tile.X + box.Left, tile.Y + box.Top, object));
    }
  }
  return anyAbsent;
}

void TileSampler::Record(const SceneBeam& beam, const Tile& tile, const PixelBox& box) const
{
  for (std::size_t object = 0; this->Beams && object < beam.Objects.size(); ++object)
  {
    if (beam.Objects[object] && beam.Objects[object]->Usable)
    {
      this->Beams->Record(
        tile.X + box.Left, tile.Y + box.Top, object, beam.Objects[object]->Reached);
    }
  }
}

void TileSampler::TraceBeam(Tile& tile, const PixelBox& box, FirstHits& hits) const
{
  if (!this->IsOpen(tile, box))
  {
    return;
  }
  SceneBeam beam = this->FindBeam(tile, box);
  if (beam.MayMeet())
  {
    this->Prefetch(beam, tile, box);
    // Rays on both sides of where they run along an axis: fewer have more in common.
    const bool splits =
      !beam.IsUsable() && (box.Width > SmallestBeamEdge || box.Height > SmallestBeamEdge);
    Split(box, splits ? SmallestBeamEdge : PixelSampler::BoxEdge,
      [&](const PixelBox& part)
      {
        if (splits)
        {
          this->TraceBeam(tile, part, hits);
        }
        else
        {
          this->TraceBatch(tile, &beam, part, hits);
        }
      });
  }
  else
  {
    SetCounts(this->Request.FirstSample + this->Request.Samples, box, tile);
  }
  this->Record(beam, tile, box);
}

void TileSampler::TraceBatch(
  Tile& tile, SceneBeam* beam, const PixelBox& box, FirstHits& hits) const
{
  if (!this->IsOpen(tile, box))
  {
    return;
  }
  const int end = this->Request.FirstSample + this->Request.Samples;
  int sample = this->Request.FirstSample;
  for (; sample < end && !this->AreEnough(sample, tile, box); ++sample)
  {
    PixelSampler::Samples samples;
    PixelSampler::FirstHits first{ nullptr, nullptr, { tile.X, tile.Y }, tile.Width };
    const auto number = static_cast<std::size_t>(sample - this->Request.FirstSample);
    if (number < hits.Known.size())
    {
      first.Known = hits.Known[number];
    }
    else if (number - hits.Known.size() < hits.Kept.size())
    {
      first.Kept = &hits.Kept[number - hits.Known.size()];
    }
    this->Pixels.Sample(
      beam, tile.X + box.Left, tile.Y + box.Top, box.Width, box.Height, sample, first, samples);
    for (int number = 0; number < samples.GetCount(); ++number)
    {
      AddSample(samples[number], tile);
    }
    for (int number = 0; tile.Present.HasMore() && number < samples.GetCount(); ++number)
    {
      AddMoreChannels(samples[number], sample, tile);
    }
    for (int number = 0; !tile.Squares.empty() && number < samples.GetCount(); ++number)
    {
      const glm::vec4& color = samples[number].Color;
      tile.Squares[GetPixel(samples[number], tile)] += glm::dot(color, color);
    }
  }
  SetCounts(sample, box, tile);
}

/// All of the pixels have so many samples.
void TileSampler::SetCounts(int samples, const PixelBox& box, Tile& tile)
{
  for (int y = box.Top; !tile.Counts.empty() && y < box.Top + box.Height; ++y)
  {
    std::fill_n(&tile.Counts[static_cast<std::size_t>(y * tile.Width + box.Left)], box.Width,
      static_cast<std::uint32_t>(samples));
  }
}

template <class Is>
bool TileSampler::FindPixel(const Tile& tile, const PixelBox& box, const Is& is)
{
  for (int y = box.Top; y < box.Top + box.Height; ++y)
  {
    for (int x = box.Left; x < box.Left + box.Width; ++x)
    {
      if (is(static_cast<std::size_t>(y) * tile.Width + static_cast<std::size_t>(x)))
      {
        return true;
      }
    }
  }
  return false;
}

/// Returns whether any pixel has got all samples so far.
bool TileSampler::IsOpen(const Tile& tile, const PixelBox& box) const
{
  return tile.Counts.empty() ||
    FindPixel(tile, box,
      [&](std::size_t pixel)
      { return static_cast<int>(tile.Counts[pixel]) == this->Request.FirstSample; });
}

/// Returns whether the pixels of a batch need no more than the samples that they have. That is decided at the powers of
/// two, however many samples a request has, and for all of the pixels together: a few samples of one may miss an edge.
bool TileSampler::AreEnough(int samples, const Tile& tile, const PixelBox& box) const
{
  const bool isPower = (samples & (samples - 1)) == 0;
  if (tile.Counts.empty() || samples < FrameRequest::SureSamples || !isPower)
  {
    return false;
  }
  const auto count = static_cast<float>(samples);
  const float limit = this->Request.Tolerance * this->Request.Tolerance * (count - 1.0f);
  return !FindPixel(tile, box,
    [&](std::size_t pixel)
    {
      const glm::vec4 mean = tile.Sum[pixel] / count;
      return tile.Squares[pixel] / count - glm::dot(mean, mean) > limit;
    });
}

void TileSampler::AddSample(const PixelSample& traced, Tile& tile)
{
  tile.LightRays += static_cast<std::uint64_t>(traced.LightRays);
  const std::size_t pixels = static_cast<std::size_t>(tile.Width) * tile.Height;
  const std::size_t pixel = GetPixel(traced, tile);
  if (tile.Layers == 1)
  {
    tile.Sum[pixel] += traced.Color;
    // A pixel is as near as the nearest of its samples, so that a surface's antialiased
    // border still covers what is behind.
    tile.Depth[pixel] = std::min(tile.Depth[pixel], traced.Depth);
    return;
  }
  for (int layer = 0; layer < traced.Layers; ++layer)
  {
    const std::size_t place = pixels * std::min(layer, tile.Layers - 1) + pixel;
    tile.Sum[place] += traced.LayerColors[layer];
    tile.Depth[place] = std::min(tile.Depth[place], traced.LayerDepths[layer]);
  }
}

} // namespace rt
