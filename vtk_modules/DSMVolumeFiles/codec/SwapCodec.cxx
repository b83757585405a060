// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/Codec.h"

#include <algorithm>
#include <utility>

namespace vol
{

namespace
{

ByteBuffer Swap(ByteBuffer bytes, const CodecParameters& with)
{
  const std::size_t width = with.Width;
  for (std::size_t at = 0; at + width <= bytes.size(); at += width)
  {
    std::reverse(bytes.data() + at, bytes.data() + at + width);
  }
  return bytes;
}

} // namespace

/// The bytes of each element in reverse order.
Codec MakeSwapCodec()
{
  Codec codec{ "swap" };
  codec.KeepsPlaces = true;
  codec.Decode = [](ByteBuffer stored, const CodecParameters& with, std::size_t)
  { return Swap(std::move(stored), with); };
  codec.Encode = &Swap;
  return codec;
}

} // namespace vol
