// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/Codec.h"
#include "DSMVolumeFiles/codec/CodecBytes.h"

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

Codec MakeDeflateCodec();

namespace
{

/// At least two bits are spent on 258 bytes.
constexpr std::uint64_t MostGrowth = 1032;

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
  ByteBuffer bytes(GetRoom(stored, MostGrowth, most));
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
  constexpr int zlibOrGzip = 15 + 32;
  const auto toCount = [](std::size_t size)
  { return static_cast<uInt>(std::min<std::size_t>(size, std::numeric_limits<uInt>::max())); };
  z_stream stream{};
  ByteBuffer bytes(GetRoom(stored, MostGrowth, most));
  stream.next_in = reinterpret_cast<Bytef*>(stored.data());
  stream.avail_in = toCount(stored.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = toCount(bytes.size());
  if (inflateInit2(&stream, zlibOrGzip) != Z_OK)
  {
    throw std::bad_alloc();
  }
  const int state = inflate(&stream, Z_FINISH);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  if (state != Z_STREAM_END)
  {
    throw dsm::Error("its deflate stream is damaged");
  }
  return bytes;
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
  codec.MostGrowth = MostGrowth;
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
