// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/codec/StreamDecoder.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/codec/CodecBytes.h"

#include <algorithm>
#include <limits>
#include <new>
#include <string>
#include <utility>

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
/// Of zlib or gzip.
struct Deflate
{
  using Stream = z_stream;
  static constexpr int Ended = Z_STREAM_END;
  static constexpr int NoMemory = Z_MEM_ERROR;

  static int Begin(Stream& stream)
  {
    constexpr int zlibOrGzip = 15 + 32;
    return inflateInit2(&stream, zlibOrGzip);
  }
  static int Run(Stream& stream)
  {
    const int state = inflate(&stream, Z_NO_FLUSH);
    return state == Z_BUF_ERROR ? Z_OK : state;
  }
  static void End(Stream& stream) { inflateEnd(&stream); }
};
#endif

#ifdef DSM_HAS_BZIP2
struct Bzip2
{
  using Stream = bz_stream;
  static constexpr int Ended = BZ_STREAM_END;
  static constexpr int NoMemory = BZ_MEM_ERROR;

  static int Begin(Stream& stream) { return BZ2_bzDecompressInit(&stream, 0, 0); }
  static int Run(Stream& stream) { return BZ2_bzDecompress(&stream); }
  static void End(Stream& stream) { BZ2_bzDecompressEnd(&stream); }
};
#endif

/// The streams of both libraries have the same members, and 0 means that there is no error.
template <class Library>
class DecoderOf final : public StreamDecoder
{
public:
  DecoderOf() { this->Begin(); }
  ~DecoderOf() override { Library::End(this->Stream); }

  std::optional<Step> Decode(
    const std::byte* in, std::size_t inBytes, std::byte* out, std::size_t outBytes) override
  {
    if (this->HasEnded)
    {
      Library::End(this->Stream);
      this->Begin();
    }
    this->Stream.next_in =
      reinterpret_cast<decltype(this->Stream.next_in)>(const_cast<std::byte*>(in));
    this->Stream.avail_in = ToCount(inBytes);
    this->Stream.next_out = reinterpret_cast<decltype(this->Stream.next_out)>(out);
    this->Stream.avail_out = ToCount(outBytes);
    const int state = Library::Run(this->Stream);
    this->HasEnded = state == Library::Ended;
    if (state == Library::NoMemory)
    {
      throw std::bad_alloc();
    }
    if (state != 0 && !this->HasEnded)
    {
      return std::nullopt;
    }
    return Step{ ToCount(inBytes) - this->Stream.avail_in,
      ToCount(outBytes) - this->Stream.avail_out, this->HasEnded };
  }

private:
  void Begin()
  {
    this->Stream = {};
    if (Library::Begin(this->Stream) != 0)
    {
      throw std::bad_alloc();
    }
  }

  typename Library::Stream Stream{};
  bool HasEnded = false;
};

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
      /// A block of 900,000 bytes, each five of which stand for up to 259, takes more than 32 bytes.
      return std::uint64_t(1) << 21;
    default:
      return 1;
  }
}

std::optional<ByteBuffer> StreamDecoder::DecodeWhole(
  StreamEncoding encoding, const ByteBuffer& stored, std::size_t most)
{
  ByteBuffer bytes(CodecBytes::GetRoom(stored, GetMostGrowth(encoding), most));
  const std::optional<Step> step =
    Make(encoding)->Decode(stored.data(), stored.size(), bytes.data(), bytes.size());
  bytes.resize(step ? step->Written : 0);
  return step && step->Ended ? std::optional<ByteBuffer>(std::move(bytes)) : std::nullopt;
}

std::unique_ptr<StreamDecoder> StreamDecoder::Make(StreamEncoding encoding)
{
  if (encoding == StreamEncoding::Bzip2)
  {
#ifdef DSM_HAS_BZIP2
    return std::make_unique<DecoderOf<Bzip2>>();
#else
    RefuseLack("bzip2", "libbz2-dev");
#endif
  }
#ifdef DSM_HAS_ZLIB
  return std::make_unique<DecoderOf<Deflate>>();
#else
  RefuseLack("deflate", "zlib1g-dev");
#endif
}

} // namespace vol
