// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameGather.h"

#include "DSMBricks/base/ByteHash.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

namespace rt
{

namespace
{

struct TileHeader
{
  std::int32_t X;
  std::int32_t Y;
  std::int32_t Width;
  std::int32_t Height;
  std::int32_t Layers;

  std::size_t GetPixels() const { return static_cast<std::size_t>(this->Width) * this->Height; }
};

/// Without the last layers that show nothing, but for the first one.
TileHeader Describe(const Tile& tile)
{
  TileHeader header{ tile.X, tile.Y, tile.Width, tile.Height, tile.Layers };
  const std::size_t pixels = header.GetPixels();
  const auto isEmpty = [&](int layer)
  {
    const auto first = tile.Depth.begin() + static_cast<std::ptrdiff_t>(pixels * layer);
    return std::all_of(first, first + static_cast<std::ptrdiff_t>(pixels),
      [](float depth) { return depth == 1.0f; });
  };
  while (header.Layers > 1 && isEmpty(header.Layers - 1))
  {
    --header.Layers;
  }
  return header;
}

template <class T>
void Append(std::vector<std::byte>& bytes, const T* values, std::size_t count)
{
  const std::size_t first = bytes.size();
  bytes.resize(first + count * sizeof(T));
  std::memcpy(bytes.data() + first, values, count * sizeof(T));
}

std::vector<std::byte> Pack(const Frame& frame)
{
  std::vector<std::byte> bytes;
  for (const Tile& tile : frame.Tiles)
  {
    const TileHeader header = Describe(tile);
    const std::size_t pixels = header.Layers * header.GetPixels();
    Append(bytes, &header, 1);
    Append(bytes, tile.Color.data(), 4 * pixels);
    Append(bytes, tile.Depth.data(), pixels);
  }
  return bytes;
}

/// Makes room for as many layers.
void Extend(int layers, Picture& picture)
{
  if (layers > picture.Layers)
  {
    const std::size_t pixels = static_cast<std::size_t>(picture.Width) * picture.Height;
    picture.Layers = layers;
    picture.Color.resize(4 * layers * pixels, 0);
    picture.Depth.resize(layers * pixels, 1.0f);
  }
}

/// Puts one tile's pixels where they belong.
void Place(const TileHeader& tile, const void* colors, const void* depths, Picture& picture)
{
  const auto* color = static_cast<const std::byte*>(colors);
  const auto* depth = static_cast<const std::byte*>(depths);
  Extend(tile.Layers, picture);
  for (int line = 0; line < tile.Layers * tile.Height; ++line)
  {
    const std::size_t layer = static_cast<std::size_t>(line) / tile.Height;
    const std::size_t row = layer * picture.Height + tile.Y + line % tile.Height;
    const std::size_t target = row * picture.Width + tile.X;
    const std::size_t source = static_cast<std::size_t>(line) * tile.Width;
    std::memcpy(&picture.Color[4 * target], color + 4 * source, 4 * tile.Width);
    std::memcpy(&picture.Depth[target], depth + sizeof(float) * source, sizeof(float) * tile.Width);
  }
}

/// Puts a rank's packed tiles into the picture; returns how many pixels they have.
std::size_t Unpack(const std::vector<std::byte>& bytes, Picture& picture)
{
  std::size_t pixels = 0;
  const std::byte* at = bytes.data();
  const std::byte* end = at + bytes.size();
  while (at < end)
  {
    TileHeader header;
    std::memcpy(&header, at, sizeof(header));
    at += sizeof(header);
    const std::size_t tilePixels = header.Layers * header.GetPixels();
    Place(header, at, at + 4 * tilePixels, picture);
    at += (4 + sizeof(float)) * tilePixels;
    pixels += header.GetPixels();
  }
  return pixels;
}

/// Whether any of a rank's packed tiles has several layers.
bool HasLayers(const std::vector<std::byte>& bytes)
{
  std::size_t at = 0;
  TileHeader header{};
  while (at < bytes.size() && header.Layers <= 1)
  {
    std::memcpy(&header, bytes.data() + at, sizeof(header));
    at += sizeof(header) + header.Layers * header.GetPixels() * (4 + sizeof(float));
  }
  return header.Layers > 1;
}

/// A pixel of the picture.
struct Edge
{
  std::uint32_t Place;
  std::uint8_t Color[4];
  float Depth;
};

std::vector<std::byte> PackEdges(const Frame& frame)
{
  std::vector<std::byte> bytes;
  for (const Tile& tile : frame.Tiles)
  {
    for (int pixel = 0; pixel < tile.Width * tile.Height; ++pixel)
    {
      const std::uint8_t* color = &tile.Color[4 * static_cast<std::size_t>(pixel)];
      if (color[3] > 0 && color[3] < 255)
      {
        const int row = tile.Y + pixel / tile.Width;
        Edge edge{ static_cast<std::uint32_t>(row * frame.Width + tile.X + pixel % tile.Width), {},
          tile.Depth[static_cast<std::size_t>(pixel)] };
        std::copy_n(color, 4, edge.Color);
        Append(bytes, &edge, 1);
      }
    }
  }
  return bytes;
}

void UnpackEdges(const std::vector<std::byte>& bytes, Picture& picture)
{
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(Edge))
  {
    Edge edge;
    std::memcpy(&edge, bytes.data() + at, sizeof(edge));
    std::copy_n(edge.Color, 4, &picture.Color[4 * static_cast<std::size_t>(edge.Place)]);
    picture.Depth[edge.Place] = edge.Depth;
  }
}

Picture CreatePicture(const Frame& frame)
{
  Picture picture;
  picture.Width = frame.Width;
  picture.Height = frame.Height;
  const std::size_t pixels = static_cast<std::size_t>(frame.Width) * frame.Height;
  picture.Color.assign(4 * pixels, 0);
  picture.Depth.assign(pixels, 1.0f);
  return picture;
}

} // namespace

Picture AssembleTiles(const Frame& frame)
{
  Picture picture = CreatePicture(frame);
  for (const Tile& tile : frame.Tiles)
  {
    Place(Describe(tile), tile.Color.data(), tile.Depth.data(), picture);
  }
  return picture;
}

Picture GatherFrame(dsm::Messenger& messenger, const Frame& frame)
{
  const char* const what = "Gathering the frame";
  Picture picture;
  const auto parts = messenger.GatherTogether(what,
    [&]
    {
      picture = CreatePicture(frame);
      return Pack(frame);
    });
  std::size_t filled = 0;
  const auto unpack = [&]
  {
    for (const auto& bytes : parts)
    {
      filled += Unpack(bytes, picture);
    }
  };
  if (std::any_of(parts.begin(), parts.end(), [](const auto& part) { return HasLayers(part); }))
  {
    messenger.RunTogether(what, unpack); // takes memory
  }
  else
  {
    unpack();
  }
  const std::size_t pixels = static_cast<std::size_t>(frame.Width) * frame.Height;
  if (filled != pixels)
  {
    throw dsm::Error("The ranks traced " + std::to_string(filled) + " of " +
      std::to_string(pixels) + " pixels: a tile was lost or traced twice.");
  }
  return picture;
}

Picture AssembleTilesWithEdges(dsm::Messenger& messenger, const Frame& frame)
{
  Picture picture;
  const auto parts = messenger.GatherTogether("Gathering the frame's edges",
    [&]
    {
      picture = AssembleTiles(frame);
      return PackEdges(frame);
    });
  for (std::size_t rank = 0; rank < parts.size(); ++rank)
  {
    if (static_cast<int>(rank) != messenger.GetRank())
    {
      UnpackEdges(parts[rank], picture);
    }
  }
  return picture;
}

std::uint64_t GetHash(const Picture& picture)
{
  bricks::ByteHash hash;
  const std::int32_t size[2] = { picture.Width, picture.Height };
  hash.Add(size, sizeof(size));
  hash.Add(picture.Color.data(), picture.Color.size());
  hash.Add(picture.Depth.data(), picture.Depth.size() * sizeof(float));
  return hash.Get();
}

} // namespace rt
