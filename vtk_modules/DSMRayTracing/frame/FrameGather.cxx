// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameGather.h"

#include "DSMRayTracing/frame/TileGrid.h"

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

void Append(std::vector<std::byte>& bytes, const void* values, std::size_t count)
{
  const std::size_t first = bytes.size();
  bytes.resize(first + count);
  std::memcpy(bytes.data() + first, values, count);
}

std::vector<std::byte> Pack(const Frame& frame)
{
  std::vector<std::byte> bytes;
  for (const Tile& tile : frame.Tiles)
  {
    const TileHeader header = Describe(tile);
    const std::size_t pixels = header.Layers * header.GetPixels();
    Append(bytes, &header, sizeof(header));
    Channels::ForEach(tile,
      [&](const auto& values, std::size_t count, auto empty)
      { Append(bytes, values.data(), count * pixels * sizeof(empty)); });
  }
  return bytes;
}

/// Copies the lines of a tile to their places in the picture, from one channel to another. `size`: bytes of a pixel.
void CopyLines(
  const TileHeader& tile, const void* from, std::size_t size, const Picture& picture, void* to)
{
  for (int line = 0; line < tile.Layers * tile.Height; ++line)
  {
    const std::size_t layer = static_cast<std::size_t>(line) / tile.Height;
    const std::size_t row = layer * picture.Height + tile.Y + line % tile.Height;
    const std::size_t source = static_cast<std::size_t>(line) * tile.Width;
    std::memcpy(static_cast<std::byte*>(to) + size * (row * picture.Width + tile.X),
      static_cast<const std::byte*>(from) + size * source, size * tile.Width);
  }
}

/// Makes room for as many layers.
void Extend(int layers, Picture& picture)
{
  if (layers > picture.Layers)
  {
    picture.Layers = layers;
    picture.Resize(static_cast<std::size_t>(picture.Width) * picture.Height * layers);
  }
}

/// Puts the pixels of a tile where they belong.
void Place(const Tile& tile, Picture& picture)
{
  const TileHeader header = Describe(tile);
  Extend(header.Layers, picture);
  Channels::ForEach(
    picture,
    [&](auto& to, std::size_t count, auto empty, const auto& from)
    { CopyLines(header, from.data(), count * sizeof(empty), picture, to.data()); },
    tile);
}

/// Calls `visit(header, values)` for each of a rank's packed tiles until it returns false; `values` are the channels
/// of the picture, one after the other.
template <class Visit>
void VisitPacked(const std::vector<std::byte>& bytes, const Picture& picture, const Visit& visit)
{
  std::size_t pixelBytes = 0;
  Channels::ForEach(picture,
    [&](const auto&, std::size_t count, auto empty) { pixelBytes += count * sizeof(empty); });
  bool goesOn = true;
  for (std::size_t at = 0; goesOn && at < bytes.size();)
  {
    TileHeader header;
    std::memcpy(&header, bytes.data() + at, sizeof(header));
    goesOn = visit(header, bytes.data() + at + sizeof(header));
    at += sizeof(header) + header.Layers * header.GetPixels() * pixelBytes;
  }
}

/// Puts a rank's packed tiles into the picture; returns how many pixels they have.
std::size_t Unpack(const std::vector<std::byte>& bytes, Picture& picture)
{
  std::size_t pixels = 0;
  VisitPacked(bytes, picture,
    [&](const TileHeader& header, const std::byte* values)
    {
      Extend(header.Layers, picture);
      Channels::ForEach(picture,
        [&](auto& to, std::size_t count, auto empty)
        {
          const std::size_t size = count * sizeof(empty);
          CopyLines(header, values, size, picture, to.data());
          values += header.Layers * header.GetPixels() * size;
        });
      pixels += header.GetPixels();
      return true;
    });
  return pixels;
}

/// Returns whether any of a rank's packed tiles has several layers.
bool HasLayers(const std::vector<std::byte>& bytes, const Picture& picture)
{
  bool has = false;
  VisitPacked(bytes, picture,
    [&](const TileHeader& header, const std::byte*)
    {
      has = header.Layers > 1;
      return !has;
    });
  return has;
}

/// Packs each partly covered pixel: its position in the image, and its channels.
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
        const auto place =
          static_cast<std::uint32_t>(row * frame.Width + tile.X + pixel % tile.Width);
        Append(bytes, &place, sizeof(place));
        Channels::ForEach(tile,
          [&](const auto& values, std::size_t count, auto empty)
          { Append(bytes, &values[count * pixel], count * sizeof(empty)); });
      }
    }
  }
  return bytes;
}

void UnpackEdges(const std::vector<std::byte>& bytes, Picture& picture)
{
  for (std::size_t at = 0; at < bytes.size();)
  {
    const auto take = [&](void* to, std::size_t size)
    {
      std::memcpy(to, bytes.data() + at, size);
      at += size;
    };
    std::uint32_t place = 0;
    take(&place, sizeof(place));
    Channels::ForEach(picture,
      [&](auto& values, std::size_t count, auto empty)
      { take(&values[count * place], count * sizeof(empty)); });
  }
}

Picture CreatePicture(const Frame& frame)
{
  return Picture::Create(frame.Width, frame.Height, 1, frame.Channels);
}

} // namespace

Picture Picture::Create(int width, int height, int layers, ChannelSet channels)
{
  Picture picture;
  picture.Width = width;
  picture.Height = height;
  picture.Layers = layers;
  picture.Reset(channels, static_cast<std::size_t>(width) * height * layers);
  return picture;
}

Picture AssembleTiles(const Frame& frame)
{
  Picture picture = CreatePicture(frame);
  for (const Tile& tile : frame.Tiles)
  {
    Place(tile, picture);
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
  if (std::any_of(
        parts.begin(), parts.end(), [&](const auto& part) { return HasLayers(part, picture); }))
  {
    messenger.RunTogether(what, unpack); // takes memory
  }
  else
  {
    unpack();
  }
  std::size_t pixels = static_cast<std::size_t>(frame.Width) * frame.Height;
  const TileGrid grid(frame.Width, frame.Height, std::max(frame.TileSize, 1));
  for (const int left : frame.Left)
  {
    const Tile tile = grid.CreateTile(left);
    pixels -= static_cast<std::size_t>(tile.Width) * tile.Height;
  }
  if (filled != pixels)
  {
    throw dsm::Error("The ranks traced " + std::to_string(filled) + " of " +
      std::to_string(pixels) +
      " pixels: a tile was lost or traced twice. This is a bug in the program.");
  }
  return picture;
}

void AddEdges(dsm::Messenger& messenger, const Frame& frame, Picture& picture)
{
  const auto parts =
    messenger.GatherTogether("Gathering the frame's edges", [&] { return PackEdges(frame); });
  for (std::size_t rank = 0; rank < parts.size(); ++rank)
  {
    if (static_cast<int>(rank) != messenger.GetRank())
    {
      UnpackEdges(parts[rank], picture);
    }
  }
}

} // namespace rt
