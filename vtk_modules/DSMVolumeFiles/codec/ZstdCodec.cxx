// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/Codec.h"
#include "DSMVolumeFiles/codec/CodecBytes.h"

#include <new>
#include <string>

#ifdef DSM_HAS_ZSTD
#include <zstd.h>
#endif

namespace vol
{

namespace
{

/// At least four bytes are spent on a block of 128 KiB.
constexpr std::uint64_t MostGrowth = 1 << 15;

#ifdef DSM_HAS_ZSTD
using namespace CodecBytes;

ByteBuffer Decode(ByteBuffer stored, const CodecParameters&, std::size_t most)
{
  ByteBuffer bytes(GetRoom(stored, MostGrowth, most));
  const std::size_t count =
    ZSTD_decompress(bytes.data(), bytes.size(), stored.data(), stored.size());
  if (ZSTD_isError(count))
  {
    throw dsm::Error(
      std::string("its Zstandard frame is damaged (") + ZSTD_getErrorName(count) + ")");
  }
  bytes.resize(count);
  return bytes;
}

ByteBuffer Encode(ByteBuffer samples, const CodecParameters&)
{
  constexpr int level = 3;
  ByteBuffer bytes(ZSTD_compressBound(samples.size()));
  const std::size_t count =
    ZSTD_compress(bytes.data(), bytes.size(), samples.data(), samples.size(), level);
  if (ZSTD_isError(count))
  {
    throw std::bad_alloc();
  }
  bytes.resize(count);
  return bytes;
}

/// In a skippable frame: with a magic number and its size before it.
void AddHalo(ByteBuffer& stored, const ByteBuffer& halo)
{
  AddNumber(stored, HaloMagic);
  AddNumber(stored, static_cast<std::uint32_t>(halo.size()));
  stored.insert(stored.end(), halo.begin(), halo.end());
}

std::optional<ByteBuffer> FindHalo(const ByteBuffer& stored)
{
  const std::size_t frame = ZSTD_findFrameCompressedSize(stored.data(), stored.size());
  if (ZSTD_isError(frame) || stored.size() < frame + HaloHeader ||
    GetNumber(stored, frame) != HaloMagic ||
    GetNumber(stored, frame + sizeof(std::uint32_t)) != stored.size() - frame - HaloHeader)
  {
    return std::nullopt;
  }
  return GetPart(stored, frame + HaloHeader, stored.size());
}
#endif

} // namespace

/// One frame.
Codec MakeZstdCodec()
{
  Codec codec{ "zstd", { "zstd" } };
  codec.HdfFilters = { 32015 }; // https://github.com/HDFGroup/hdf5_plugins
  codec.IsCompressor = true;
  codec.MostGrowth = MostGrowth;
#ifdef DSM_HAS_ZSTD
  codec.Decode = &Decode;
  codec.Encode = &Encode;
  codec.AddHalo = &AddHalo;
  codec.FindHalo = &FindHalo;
#else
  codec.LackingPackage = "libzstd-dev";
#endif
  return codec;
}

} // namespace vol
