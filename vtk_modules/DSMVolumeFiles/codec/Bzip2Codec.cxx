// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/Codec.h"
#include "DSMVolumeFiles/codec/CodecBytes.h"

#include <limits>
#include <new>

#ifdef DSM_HAS_BZIP2
#include <bzlib.h>
#endif

namespace vol
{

Codec MakeBzip2Codec();

namespace
{

/// A block of 900,000 bytes, each five of which stand for up to 259, takes more than 32 bytes.
constexpr std::uint64_t MostGrowth = 1 << 21;

#ifdef DSM_HAS_BZIP2
unsigned ToCount(std::size_t size)
{
  return static_cast<unsigned>(std::min<std::size_t>(size, std::numeric_limits<unsigned>::max()));
}

ByteBuffer Decode(ByteBuffer stored, const CodecParameters&, std::size_t most)
{
  bz_stream stream{};
  ByteBuffer bytes(CodecBytes::GetRoom(stored, MostGrowth, most));
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK)
  {
    throw std::bad_alloc();
  }
  stream.next_in = reinterpret_cast<char*>(stored.data());
  stream.avail_in = ToCount(stored.size());
  stream.next_out = reinterpret_cast<char*>(bytes.data());
  stream.avail_out = ToCount(bytes.size());
  const int state = BZ2_bzDecompress(&stream);
  const std::size_t count =
    static_cast<std::size_t>(stream.next_out - reinterpret_cast<char*>(bytes.data()));
  BZ2_bzDecompressEnd(&stream);
  if (state != BZ_STREAM_END)
  {
    throw dsm::Error("its bzip2 stream is damaged");
  }
  bytes.resize(count);
  return bytes;
}
#endif

} // namespace

/// One stream.
Codec MakeBzip2Codec()
{
  Codec codec{ "bzip2", { "bz2" } };
  codec.HdfFilters = { 307 };
  codec.IsCompressor = true;
  codec.MostGrowth = MostGrowth;
#ifdef DSM_HAS_BZIP2
  codec.Decode = &Decode;
#else
  codec.LackingPackage = "libbz2-dev";
#endif
  return codec;
}

} // namespace vol
