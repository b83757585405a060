// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/Codec.h"
#include "DSMVolumeFiles/codec/CodecBytes.h"

#include <cstring>
#include <limits>

#ifdef DSM_HAS_LZ4
#include <lz4.h>
#endif

namespace vol
{

namespace
{

/// A byte of a length stands for at most 255 bytes.
constexpr std::uint64_t MostGrowth = 256;

#ifdef DSM_HAS_LZ4
[[noreturn]] void RefuseDamaged()
{
  throw dsm::Error("its LZ4 data are damaged");
}

void DecodeBlock(const std::byte* stored, std::size_t count, std::byte* out, std::size_t bytes)
{
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (count > most || bytes > most ||
    LZ4_decompress_safe(reinterpret_cast<const char*>(stored), reinterpret_cast<char*>(out),
      static_cast<int>(count), static_cast<int>(bytes)) != static_cast<int>(bytes))
  {
    RefuseDamaged();
  }
}

/// numcodecs: the size in 4 bytes, low byte first, and a block.
ByteBuffer Decode(ByteBuffer stored, const CodecParameters&, std::size_t most)
{
  constexpr std::size_t header = sizeof(std::uint32_t);
  const std::size_t size = stored.size() < header ? 0 : CodecBytes::GetNumber(stored, 0);
  if (stored.size() < header || size > CodecBytes::GetRoom(stored, MostGrowth, most))
  {
    RefuseDamaged();
  }
  ByteBuffer bytes(size);
  DecodeBlock(stored.data() + header, stored.size() - header, bytes.data(), size);
  return bytes;
}

/// High byte first.
std::uint64_t TakeNumber(const ByteBuffer& stored, std::size_t& at, std::size_t bytes)
{
  if (stored.size() - at < bytes)
  {
    RefuseDamaged();
  }
  std::uint64_t number = 0;
  for (const std::size_t end = at + bytes; at < end; ++at)
  {
    number = number << 8 | std::to_integer<std::uint64_t>(stored[at]);
  }
  return number;
}

/// HDF5: the size in 8 bytes, the size of a block in 4, and blocks, each with its stored size in 4 before it. A block
/// that does not shrink is stored as it is.
ByteBuffer DecodeHdf(ByteBuffer stored, const CodecParameters&, std::size_t most)
{
  std::size_t at = 0;
  const std::uint64_t size = TakeNumber(stored, at, sizeof(std::uint64_t));
  const std::uint64_t block = TakeNumber(stored, at, sizeof(std::uint32_t));
  if (size > CodecBytes::GetRoom(stored, MostGrowth, most) || block == 0)
  {
    RefuseDamaged();
  }
  ByteBuffer bytes(static_cast<std::size_t>(size));
  for (std::size_t done = 0; done < bytes.size();)
  {
    const auto count =
      static_cast<std::size_t>(std::min<std::uint64_t>(block, bytes.size() - done));
    const std::uint64_t has = TakeNumber(stored, at, sizeof(std::uint32_t));
    if (has > stored.size() - at)
    {
      RefuseDamaged();
    }
    if (has == count)
    {
      std::memcpy(bytes.data() + done, stored.data() + at, count);
    }
    else
    {
      DecodeBlock(stored.data() + at, static_cast<std::size_t>(has), bytes.data() + done, count);
    }
    at += static_cast<std::size_t>(has);
    done += count;
  }
  return bytes;
}
#endif

Codec MakeCodec(std::string_view name)
{
  Codec codec{ name };
  codec.IsCompressor = true;
  codec.MostGrowth = MostGrowth;
#ifndef DSM_HAS_LZ4
  codec.LackingPackage = "liblz4-dev";
#endif
  return codec;
}

} // namespace

Codec MakeLz4Codec()
{
  Codec codec = MakeCodec("lz4");
  codec.ZarrNames = { "lz4" };
#ifdef DSM_HAS_LZ4
  codec.Decode = &Decode;
#endif
  return codec;
}

Codec MakeHdfLz4Codec()
{
  Codec codec = MakeCodec("HDF5's lz4");
  codec.HdfFilters = { 32004 }; // https://github.com/HDFGroup/hdf5_plugins
#ifdef DSM_HAS_LZ4
  codec.Decode = &DecodeHdf;
#endif
  return codec;
}

} // namespace vol
