// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/Codec.h"
#include "DSMVolumeFiles/codec/CodecBytes.h"
#include "DSMVolumeFiles/codec/StreamDecoder.h"

#include <limits>
#include <memory>
#include <new>

#ifdef DSM_HAS_LIBDEFLATE
#include <libdeflate.h>
#endif
#ifdef DSM_HAS_ZLIB
#include <zlib.h>
#endif

namespace vol
{

namespace
{

#ifdef DSM_HAS_ZLIB
using namespace CodecBytes;

#ifdef DSM_HAS_LIBDEFLATE
ByteBuffer Decode(ByteBuffer stored, const CodecParameters&, std::size_t most)
{
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> machine(
    libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  if (!machine)
  {
    throw std::bad_alloc();
  }
  const bool gzip =
    stored.size() > 1 && stored[0] == std::byte(0x1f) && stored[1] == std::byte(0x8b);
  ByteBuffer bytes(GetRoom(stored, StreamDecoder::GetMostGrowth(StreamEncoding::Deflate), most));
  std::size_t used = 0;
  std::size_t count = 0;
  const libdeflate_result result =
    (gzip ? libdeflate_gzip_decompress_ex : libdeflate_zlib_decompress_ex)(
      machine.get(), stored.data(), stored.size(), bytes.data(), bytes.size(), &used, &count);
  if (result != LIBDEFLATE_SUCCESS)
  {
    throw dsm::Error("its deflate stream is damaged");
  }
  bytes.resize(count);
  return bytes;
}
#else
ByteBuffer Decode(ByteBuffer stored, const CodecParameters&, std::size_t most)
{
  auto bytes = StreamDecoder::DecodeWhole(StreamEncoding::Deflate, stored, most);
  if (!bytes)
  {
    throw dsm::Error("its deflate stream is damaged");
  }
  return std::move(*bytes);
}
#endif

ByteBuffer Encode(ByteBuffer samples, const CodecParameters&)
{
  // Fast, and hardly larger than what higher levels make of scientific data.
  constexpr int level = 3;
  uLongf count = compressBound(samples.size());
  ByteBuffer bytes(count);
  if (compress2(reinterpret_cast<Bytef*>(bytes.data()), &count,
        reinterpret_cast<const Bytef*>(samples.data()), samples.size(), level) != Z_OK)
  {
    throw std::bad_alloc();
  }
  bytes.resize(count);
  return bytes;
}

/// Behind the stream, whose end only decoding finds: the size and the magic number come last.
void AddHalo(ByteBuffer& stored, const ByteBuffer& halo)
{
  stored.insert(stored.end(), halo.begin(), halo.end());
  AddNumber(stored, static_cast<std::uint32_t>(halo.size()));
  AddNumber(stored, HaloMagic);
}

std::optional<ByteBuffer> FindHalo(const ByteBuffer& stored)
{
  const std::size_t last = stored.size() - HaloHeader;
  const std::uint32_t size = GetNumber(stored, last);
  if (GetNumber(stored, last + sizeof(std::uint32_t)) != HaloMagic || size > last)
  {
    return std::nullopt;
  }
  return GetPart(stored, last - size, last);
}
#endif

} // namespace

/// A zlib or gzip stream.
Codec MakeDeflateCodec()
{
  Codec codec{ "deflate", { "zlib", "gzip" } };
  codec.HdfFilters = { 1 };
  codec.IsCompressor = true;
  codec.MostGrowth = StreamDecoder::GetMostGrowth(StreamEncoding::Deflate);
#ifdef DSM_HAS_ZLIB
  codec.Decode = &Decode;
  codec.Encode = &Encode;
  codec.AddHalo = &AddHalo;
  codec.FindHalo = &FindHalo;
#else
  codec.LackingPackage = "zlib1g-dev";
#endif
  return codec;
}

} // namespace vol
