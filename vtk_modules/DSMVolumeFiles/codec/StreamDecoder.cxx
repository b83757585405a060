// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/StreamDecoder.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <limits>
#include <new>
#include <string>

#ifdef DSM_HAS_ZLIB
#include <zlib.h>
#endif
#ifdef DSM_HAS_BZIP2
#include <bzlib.h>
#endif

namespace vol
{

namespace
{

/// Both libraries count with 32 bits.
[[maybe_unused]] unsigned int ToCount(std::size_t bytes)
{
  return static_cast<unsigned int>(
    std::min<std::size_t>(bytes, std::numeric_limits<unsigned int>::max()));
}

#ifdef DSM_HAS_ZLIB
class DeflateDecoder final : public StreamDecoder
{
public:
  DeflateDecoder()
  {
    constexpr int zlibOrGzip = 15 + 32;
    if (inflateInit2(&this->Stream, zlibOrGzip) != Z_OK)
    {
      throw std::bad_alloc();
    }
  }
  ~DeflateDecoder() override { inflateEnd(&this->Stream); }

  Step Decode(
    const std::byte* in, std::size_t inBytes, std::byte* out, std::size_t outBytes) override
  {
    if (this->HasEnded)
    {
      inflateReset(&this->Stream);
    }
    this->Stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(in));
    this->Stream.avail_in = ToCount(inBytes);
    this->Stream.next_out = reinterpret_cast<Bytef*>(out);
    this->Stream.avail_out = ToCount(outBytes);
    const int state = inflate(&this->Stream, Z_NO_FLUSH);
    this->HasEnded = state == Z_STREAM_END;
    if (state == Z_MEM_ERROR)
    {
      throw std::bad_alloc();
    }
    if (state != Z_OK && state != Z_BUF_ERROR && !this->HasEnded)
    {
      throw dsm::Error("its compressed values are damaged");
    }
    return { ToCount(inBytes) - this->Stream.avail_in, ToCount(outBytes) - this->Stream.avail_out,
      this->HasEnded };
  }

private:
  z_stream Stream{};
  bool HasEnded = false;
};
#endif

#ifdef DSM_HAS_BZIP2
class Bzip2Decoder final : public StreamDecoder
{
public:
  Bzip2Decoder() { this->Begin(); }
  ~Bzip2Decoder() override { BZ2_bzDecompressEnd(&this->Stream); }

  Step Decode(
    const std::byte* in, std::size_t inBytes, std::byte* out, std::size_t outBytes) override
  {
    if (this->HasEnded)
    {
      BZ2_bzDecompressEnd(&this->Stream);
      this->Begin();
    }
    this->Stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(in));
    this->Stream.avail_in = ToCount(inBytes);
    this->Stream.next_out = reinterpret_cast<char*>(out);
    this->Stream.avail_out = ToCount(outBytes);
    const int state = BZ2_bzDecompress(&this->Stream);
    this->HasEnded = state == BZ_STREAM_END;
    if (state == BZ_MEM_ERROR)
    {
      throw std::bad_alloc();
    }
    if (state != BZ_OK && !this->HasEnded)
    {
      throw dsm::Error("its compressed values are damaged");
    }
    return { ToCount(inBytes) - this->Stream.avail_in, ToCount(outBytes) - this->Stream.avail_out,
      this->HasEnded };
  }

private:
  void Begin()
  {
    this->Stream = {};
    if (BZ2_bzDecompressInit(&this->Stream, 0, 0) != BZ_OK)
    {
      throw std::bad_alloc();
    }
  }

  bz_stream Stream{};
  bool HasEnded = false;
};
#endif

[[noreturn, maybe_unused]] void RefuseLack(const std::string& what, const std::string& package)
{
  throw dsm::Error("its values are compressed with " + what +
    ", which this build lacks. Install the package " + package + " and build again");
}

} // namespace

std::uint64_t StreamDecoder::GetMostGrowth(StreamEncoding encoding)
{
  switch (encoding)
  {
    case StreamEncoding::Deflate:
      return 1032; // at least two bits are spent on 258 bytes
    case StreamEncoding::Bzip2:
      return std::uint64_t(1) << 22; // 46 MB of one value are a block of some 40 bytes
    default:
      return 1;
  }
}

std::unique_ptr<StreamDecoder> StreamDecoder::Make(StreamEncoding encoding)
{
  if (encoding == StreamEncoding::Bzip2)
  {
#ifdef DSM_HAS_BZIP2
    return std::make_unique<Bzip2Decoder>();
#else
    RefuseLack("bzip2", "libbz2-dev");
#endif
  }
#ifdef DSM_HAS_ZLIB
  return std::make_unique<DeflateDecoder>();
#else
  RefuseLack("deflate", "zlib1g-dev");
#endif
}

} // namespace vol
