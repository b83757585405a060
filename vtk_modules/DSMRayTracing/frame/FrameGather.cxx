// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/FrameGather.h"

#include "DSMRayTracing/frame/ByteHash.h"

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
};

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
    const TileHeader header{ tile.X, tile.Y, tile.Width, tile.Height };
    Append(bytes, &header, 1);
    Append(bytes, tile.Color.data(), tile.Color.size());
    Append(bytes, tile.Depth.data(), tile.Depth.size());
  }
  return bytes;
}

/// Puts one tile's pixels where they belong.
void Place(const TileHeader& tile, const void* colors, const void* depths, Picture& picture)
{
  const auto* color = static_cast<const std::byte*>(colors);
  const auto* depth = static_cast<const std::byte*>(depths);
  for (int row = 0; row < tile.Height; ++row)
  {
    const std::size_t target = static_cast<std::size_t>(tile.Y + row) * picture.Width + tile.X;
    const std::size_t source = static_cast<std::size_t>(row) * tile.Width;
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
    const std::size_t tilePixels = static_cast<std::size_t>(header.Width) * header.Height;
    Place(header, at, at + 4 * tilePixels, picture);
    at += (4 + sizeof(float)) * tilePixels;
    pixels += tilePixels;
  }
  return pixels;
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
    Place(
      { tile.X, tile.Y, tile.Width, tile.Height }, tile.Color.data(), tile.Depth.data(), picture);
  }
  return picture;
}

Picture GatherFrame(dsm::Messenger& messenger, const Frame& frame)
{
  const char* const what = "Gathering the frame";
  Picture picture;
  std::vector<std::byte> mine;
  messenger.RunTogether(what,
    [&]
    {
      picture = CreatePicture(frame);
      mine = Pack(frame);
    });
  std::size_t filled = 0;
  for (const auto& bytes : messenger.AllGather(std::move(mine)))
  {
    filled += Unpack(bytes, picture);
  }
  if (filled != picture.Depth.size())
  {
    throw dsm::Error("The ranks traced " + std::to_string(filled) + " of " +
      std::to_string(picture.Depth.size()) + " pixels: a tile was lost or traced twice.");
  }
  return picture;
}

std::uint64_t GetHash(const Picture& picture)
{
  ByteHash hash;
  const std::int32_t size[2] = { picture.Width, picture.Height };
  hash.Add(size, sizeof(size));
  hash.Add(picture.Color.data(), picture.Color.size());
  hash.Add(picture.Depth.data(), picture.Depth.size() * sizeof(float));
  return hash.Get();
}

} // namespace rt
