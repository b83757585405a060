// SPDX-License-Identifier: BSD-3-Clause
#ifndef PictureHash_h
#define PictureHash_h

#include "DSMRayTracing/frame/FrameGather.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

/// A number that two pictures share if, for all practical purposes, they are equal bit for bit: 64-bit FNV-1a over
/// words of eight bytes of size and channels, with a fold that carries their high bits down. Tests have recorded
/// it.
inline std::uint64_t GetPictureHash(const rt::Picture& picture)
{
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](const void* data, std::size_t bytes)
  {
    const auto* const from = static_cast<const std::byte*>(data);
    for (std::size_t at = 0; at < bytes; at += sizeof(std::uint64_t))
    {
      std::uint64_t word = 0;
      std::memcpy(&word, from + at, std::min(sizeof(word), bytes - at));
      hash = (hash ^ word) * 0x100000001b3u;
      hash ^= hash >> 32;
    }
  };
  const std::int32_t size[2] = { picture.Width, picture.Height };
  add(size, sizeof(size));
  rt::Channels::ForEach(picture,
    [&](const auto& values, std::size_t, auto empty)
    { add(values.data(), values.size() * sizeof(empty)); });
  return hash;
}

#endif
