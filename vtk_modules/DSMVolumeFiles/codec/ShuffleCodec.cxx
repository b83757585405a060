// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/Codec.h"
#include "DSMVolumeFiles/codec/CodecJson.h"

#include <algorithm>
#include <type_traits>

namespace vol
{

namespace
{

ByteBuffer Shuffle(ByteBuffer samples, const CodecParameters& with)
{
  const std::size_t width = with.Width;
  const std::size_t count = samples.size() / width;
  ByteBuffer bytes(samples.size());
  for (std::size_t byte = 0; byte < width; ++byte)
  {
    for (std::size_t element = 0; element < count; ++element)
    {
      bytes[byte * count + element] = samples[element * width + byte];
    }
  }
  // Bytes behind the last whole element stay where they are.
  std::copy_n(
    samples.data() + count * width, samples.size() - count * width, bytes.data() + count * width);
  return bytes;
}

ByteBuffer Unshuffle(ByteBuffer stored, const CodecParameters& with, std::size_t)
{
  const std::size_t width = with.Width;
  ByteBuffer bytes(stored.size());
  const auto put = [from = stored.data(), to = bytes.data(), all = stored.size()](auto elementBytes)
  {
    const std::size_t count = all / elementBytes;
    for (std::size_t element = 0; element < count; ++element)
    {
      for (std::size_t byte = 0; byte < elementBytes; ++byte)
      {
        to[element * elementBytes + byte] = from[byte * count + element];
      }
    }
    // Bytes behind the last whole element stay where they are.
    std::copy(from + count * elementBytes, from + all, to + count * elementBytes);
  };
  // Compilers make vectors of a width that they know.
  switch (width)
  {
    case 2:
      put(std::integral_constant<std::size_t, 2>());
      break;
    case 4:
      put(std::integral_constant<std::size_t, 4>());
      break;
    case 8:
      put(std::integral_constant<std::size_t, 8>());
      break;
    default:
      put(width);
  }
  return bytes;
}

/// As numcodecs has it.
CodecParameters ParseZarr(const nlohmann::json& configuration, const ElementType&)
{
  constexpr std::int64_t usual = 4;
  constexpr std::int64_t most = 256;
  const std::int64_t width = CodecJson::GetInteger(configuration, "elementsize", usual, 0, most);
  return { static_cast<std::size_t>(std::max<std::int64_t>(1, width)) };
}

} // namespace

/// The first bytes of all elements of a width, then the second ones, and so on.
Codec MakeShuffleCodec()
{
  Codec codec{ "shuffle", { "shuffle" } };
  codec.HdfFilters = { 2 };
  codec.ParseZarr = &ParseZarr;
  codec.Decode = &Unshuffle;
  codec.Encode = &Shuffle;
  return codec;
}

} // namespace vol
