// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/LightFilter.h"

#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/FragmentStream.h"
#include "DSMCore/publish/Publication.h"
#include "DSMRayTracing/look/PackedColor.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace rt
{

namespace
{

/// Values of a pixel that the filter needs: plain, for messages.
struct NoisyPixel
{
  glm::vec4 Color;     ///< premultiplied
  glm::vec3 Open;      ///< the same without shadows and occlusion
  PackedNormal Normal; ///< of sample 0
  float Depth;
  float Variance;
};

/// A block of such pixels, row by row, before them in a message.
struct NoisyBlock
{
  std::int32_t X;
  std::int32_t Y;
  std::int32_t Width;
  std::int32_t Height;

  std::size_t GetPixels() const { return static_cast<std::size_t>(this->Width) * this->Height; }
};

/// Rows of a picture: those from First on, up to End.
struct RowRange
{
  int First;
  int End;

  /// Those and `more` on both sides, within a picture of that height.
  RowRange Grow(int more, int height) const
  {
    return { std::max(this->First - more, 0), std::min(this->End + more, height) };
  }
  RowRange GetCommon(const Tile& tile) const
  {
    return { std::max(this->First, tile.Y), std::min(this->End, tile.Y + tile.Height) };
  }
};

/// Samples from which their own variance says more than that of pixels around.
constexpr int ManySamples = 12;
/// Rows that a rank filters at a time, at most: more take more memory, fewer more time for those between them.
constexpr int RowsOfStrip = 512;
/// Light below this, of 1, is too faint to divide by.
constexpr float LeastLight = 1.0f / 512.0f;

/// The number of passes. The more samples, the less a pixel needs of those around.
int GetPasses(int samples)
{
  return samples < ManySamples ? 4 : samples < 32 ? 3 : 2;
}

/// Rows on each side that a row depends on, from the pass on.
int GetReach(int pass, int passes)
{
  int reach = 0;
  for (; pass < passes; ++pass)
  {
    reach += 2 << pass;
  }
  return reach;
}

/// Rows that it depends on at most.
constexpr int LongestReach = 2 + 2 + 4 + 8 + 16;

/// The samples that each pixel of this rank has at least.
int CountSamples(const Frame& frame)
{
  int least = std::numeric_limits<int>::max();
  for (const Tile& tile : frame.Tiles)
  {
    least = std::min(least, tile.Samples);
  }
  return least;
}

float GetMean(const glm::vec3& color)
{
  return (color.x + color.y + color.z) / 3.0f;
}

NoisyPixel GetPixel(const Tile& tile, std::size_t pixel)
{
  const auto samples = static_cast<float>(tile.CountSamples(pixel));
  NoisyPixel noisy;
  noisy.Color = tile.Sum[pixel] / samples;
  noisy.Open = tile.OpenSum[pixel] / samples;
  noisy.Normal = tile.Normals[pixel];
  noisy.Depth = tile.Depth[pixel];
  const float open = GetMean(noisy.Open);
  const float part = open > 0.0f ? GetMean(glm::vec3(noisy.Color)) / open : 1.0f;
  noisy.Variance = samples < 2.0f
    ? 0.0f
    : std::max(tile.ArrivingSquares[pixel] / samples - part * part, 0.0f) / (samples - 1.0f);
  return noisy;
}

/// Rows that the ranks filter at the same time. The picture is cut into equal strips; each rank has several, one after
/// the other.
struct Strips
{
  int Height; ///< of the picture
  int Ranks;
  int CountOfRank;
  int Number; ///< of those of a rank

  RowRange GetOwn(int rank) const
  {
    const std::int64_t count = static_cast<std::int64_t>(this->Ranks) * this->CountOfRank;
    const std::int64_t strip = static_cast<std::int64_t>(rank) * this->CountOfRank + this->Number;
    return { static_cast<int>(strip * this->Height / count),
      static_cast<int>((strip + 1) * this->Height / count) };
  }
  /// And those that they depend on.
  RowRange GetAll(int rank) const { return this->GetOwn(rank).Grow(LongestReach, this->Height); }
};

/// Yields the pixels that each rank needs of this rank's tiles.
class NoisySource final : public dsm::FragmentSource
{
public:
  NoisySource(const Frame& frame, const Strips& strips)
    : Tiles(frame.Tiles)
    , Rows(strips)
  {
  }

  bool Next(dsm::Fragment& fragment) override
  {
    for (; this->Number < this->Tiles.size(); ++this->Number, this->Rank = 0)
    {
      const Tile& tile = this->Tiles[this->Number];
      while (this->Rank < this->Rows.Ranks)
      {
        const int rank = this->Rank++;
        const RowRange rows = this->Rows.GetAll(rank).GetCommon(tile);
        if (rows.First < rows.End)
        {
          fragment.Block = static_cast<dsm::BlockId>(rank);
          Pack(tile, { tile.X, rows.First, tile.Width, rows.End - rows.First }, fragment.Bytes);
          return true;
        }
      }
    }
    return false;
  }

  double GetProgress() const override { return 0.0; }

private:
  static void Pack(const Tile& tile, const NoisyBlock& block, std::vector<std::byte>& bytes)
  {
    bytes.resize(sizeof(block) + block.GetPixels() * sizeof(NoisyPixel));
    std::memcpy(bytes.data(), &block, sizeof(block));
    std::byte* to = bytes.data() + sizeof(block);
    const std::size_t first = static_cast<std::size_t>(block.Y - tile.Y) * tile.Width;
    for (std::size_t pixel = first; pixel < first + block.GetPixels(); ++pixel)
    {
      const NoisyPixel noisy = GetPixel(tile, pixel);
      std::memcpy(to, &noisy, sizeof(noisy));
      to += sizeof(noisy);
    }
  }

  const std::vector<Tile>& Tiles;
  const Strips Rows;
  std::size_t Number = 0;
  int Rank = 0;
};

/// The rows that this rank filters, and those that they depend on.
class NoisyRows
{
public:
  NoisyRows(const Frame& frame, const glm::dmat4& worldToClip, const Strips& strips, int rank,
    LightPlanes& planes)
    : Width(frame.Width)
    , Height(frame.Height)
    , Own(strips.GetOwn(rank))
    , All(strips.GetAll(rank))
    , Planes(planes)
    , ClipToWorld(glm::inverse(worldToClip))
    , Middle(this->GetPlace(0.5 * frame.Width, 0.5 * frame.Height, 0.5))
  {
    this->Planes.Reset(this->Width, this->All.First, this->All.End - this->All.First);
    this->Result.Y = this->Own.First;
    this->Result.Width = this->Width;
    this->Result.Height = this->Own.End - this->Own.First;
    this->Result.Reset({}, static_cast<std::size_t>(this->Width) * this->Result.Height);
  }

  /// Takes a block out of a message.
  void Absorb(const std::byte* bytes)
  {
    NoisyBlock block;
    std::memcpy(&block, bytes, sizeof(block));
    bytes += sizeof(block);
    for (int row = block.Y; row < block.Y + block.Height; ++row)
    {
      for (int x = block.X; x < block.X + block.Width; ++x, bytes += sizeof(NoisyPixel))
      {
        NoisyPixel pixel;
        std::memcpy(&pixel, bytes, sizeof(pixel));
        this->Put(pixel, x, row);
      }
    }
  }

  /// Takes a tile of this rank. Any thread; others may take other tiles meanwhile.
  void Absorb(const Tile& tile)
  {
    const RowRange rows = this->All.GetCommon(tile);
    for (int row = rows.First; row < rows.End; ++row)
    {
      for (int x = 0; x < tile.Width; ++x)
      {
        const std::size_t pixel = static_cast<std::size_t>(row - tile.Y) * tile.Width + x;
        this->Put(GetPixel(tile, pixel), tile.X + x, row);
      }
    }
  }

  /// Returns the filtered rows. `samples`: that each pixel has at least. `run(first, end, task)` calls `task(row)` for
  /// each of the rows, in any order and on any threads.
  template <class Run>
  Tile Filter(int samples, const Run& run)
  {
    const LightKernel& kernel = LightKernel::GetBest();
    const int passes = GetPasses(samples);
    const auto runAround = [&](int reach, const auto& task)
    {
      const RowRange rows = this->Own.Grow(reach, this->Height);
      run(rows.First, rows.End, task);
    };
    runAround(GetReach(0, passes),
      [&](int row) { kernel.FindContrast(this->Planes, row, samples >= ManySamples); });
    LightPlanes::Plane from = LightPlanes::Red;
    for (int pass = 0; pass < passes; ++pass)
    {
      // Each pass halves the noise, about. Before the first two, the light of few samples is nothing but noise.
      const float contrast =
        samples < ManySamples && pass < 2 ? 0.0f : static_cast<float>(1 << pass);
      runAround(GetReach(pass + 1, passes),
        [&](int row) { kernel.Smooth(this->Planes, row, 1 << pass, contrast, from); });
      from = from == LightPlanes::Red ? LightPlanes::OtherRed : LightPlanes::Red;
    }
    runAround(0, [&](int row) { this->Color(row, from); });
    return std::move(this->Result);
  }

private:
  glm::dvec3 GetPlace(double x, double y, double depth) const
  {
    const glm::dvec4 clip(
      2.0 * x / this->Width - 1.0, 2.0 * y / this->Height - 1.0, 2.0 * depth - 1.0, 1.0);
    const glm::dvec4 world = this->ClipToWorld * clip;
    return glm::dvec3(world) / world.w;
  }

  /// The place of a pixel's color in the result.
  std::uint8_t* GetColor(int x, int row)
  {
    return &this->Result.Color[4 *
      (static_cast<std::size_t>(row - this->Own.First) * static_cast<std::size_t>(this->Width) +
        static_cast<std::size_t>(x))];
  }

  /// Puts a pixel into the planes, and into the result as it is.
  void Put(const NoisyPixel& pixel, int x, int row)
  {
    if (row >= this->Own.First && row < this->Own.End)
    {
      std::uint8_t* const color = this->GetColor(x, row);
      for (int channel = 0; channel < 4; ++channel)
      {
        color[channel] = PackedColor::ToByte(pixel.Color[channel]);
      }
      this->Result.Depth[static_cast<std::size_t>(color - this->Result.Color.data()) / 4] =
        pixel.Depth;
    }
    const float open = GetMean(pixel.Open);
    if (open < LeastLight || pixel.Normal.IsNone())
    {
      return;
    }
    const auto put = [&](int plane, float value) { this->Planes.GetRow(plane, row)[x] = value; };
    const float part = GetMean(glm::vec3(pixel.Color)) / open;
    const glm::vec3 normal = pixel.Normal.Get();
    const glm::dvec3 place = this->GetPlace(x + 0.5, row + 0.5, pixel.Depth);
    const double length = glm::distance(place, this->GetPlace(x + 1.5, row + 0.5, pixel.Depth));
    for (int axis = 0; axis < 3; ++axis)
    {
      put(LightPlanes::Red + axis,
        pixel.Open[axis] < LeastLight ? part : pixel.Color[axis] / pixel.Open[axis]);
      put(LightPlanes::NormalX + axis, normal[axis]);
      put(LightPlanes::PlaceX + axis, static_cast<float>(place[axis] - this->Middle[axis]));
      put(LightPlanes::OpenRed + axis, pixel.Open[axis]);
    }
    put(LightPlanes::Fineness, static_cast<float>(1.0 / length));
    put(LightPlanes::Weight, 1.0f);
    put(LightPlanes::Variance, pixel.Variance);
  }

  /// Colors a row of the result by the planes of filtered light.
  void Color(int row, LightPlanes::Plane light)
  {
    const float* const weights = this->Planes.GetRow(LightPlanes::Weight, row);
    for (int channel = 0; channel < 3; ++channel)
    {
      const float* const parts = this->Planes.GetRow(light + channel, row);
      const float* const open = this->Planes.GetRow(LightPlanes::OpenRed + channel, row);
      for (int x = 0; x < this->Width; ++x)
      {
        if (weights[x] > 0.0f)
        {
          this->GetColor(x, row)[channel] = PackedColor::ToByte(open[x] * parts[x]);
        }
      }
    }
  }

  int Width;
  int Height;
  RowRange Own;
  RowRange All;
  LightPlanes& Planes;
  glm::dmat4 ClipToWorld;
  glm::dvec3 Middle;
  Tile Result;
};

} // namespace

bool LightFilter::IsNoisy(const Scene& scene)
{
  const LightTransport& light = scene.Transport;
  const bool areSoft = (light.Shadows || light.FaintShadows) && light.LightRadius > 0.0;
  return !scene.Objects.empty() && scene.View == DebugView::Off &&
    (areSoft || light.AmbientOcclusionSamples > 0);
}

Frame LightFilter::Apply(int workers, const glm::dmat4& worldToClip, const Frame& frame)
{
  const char* const what = "Cannot filter the light of the picture";
  const int rank = this->Messenger.GetRank();
  const int ranks = this->Messenger.GetSize();
  const auto run = [&](int first, int end, dsm::FunctionRef<void(int)> task)
  {
    this->Pool.Start(
      workers,
      [&](int worker)
      {
        for (int number = first + worker; number < end; number += workers)
        {
          task(number);
        }
      },
      [] {});
    this->Pool.Wait();
  };
  const auto samples =
    this->Messenger.GatherValueTogether(what, [&] { return CountSamples(frame); });
  const int least = *std::min_element(samples.begin(), samples.end());
  Frame filtered;
  Strips strips{ frame.Height, ranks, 1 + (frame.Height - 1) / (ranks * RowsOfStrip), 0 };
  for (; strips.Number < strips.CountOfRank; ++strips.Number)
  {
    std::optional<NoisyRows> rows;
    this->Messenger.RunTogether(
      what, [&] { rows.emplace(frame, worldToClip, strips, rank, this->Planes); });
    if (ranks == 1)
    {
      run(0, static_cast<int>(frame.Tiles.size()),
        [&](int tile) { rows->Absorb(frame.Tiles[static_cast<std::size_t>(tile)]); });
    }
    else
    {
      NoisySource source(frame, strips);
      dsm::FragmentStream::RunToRanks(what, this->Messenger, source,
        [&](dsm::BlockId, const std::byte* bytes, std::size_t) { rows->Absorb(bytes); });
    }
    this->Messenger.RunTogether(what, [&] { filtered.Tiles.push_back(rows->Filter(least, run)); });
  }
  filtered.Width = frame.Width;
  filtered.Height = frame.Height;
  filtered.TileSize = frame.TileSize;
  filtered.Number = frame.Number;
  return filtered;
}

} // namespace rt
