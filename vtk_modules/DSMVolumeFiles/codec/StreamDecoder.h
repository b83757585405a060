// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_StreamDecoder_h
#define vol_StreamDecoder_h

#include "DSMVolumeFiles/base/ByteBuffer.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace vol
{

/// How a file stores all of its values, one after the other.
enum class StreamEncoding
{
  Plain,
  Deflate, ///< one or more gzip or zlib streams
  Bzip2
};

/// Unpacks streams of any length with little memory, piece after piece. One thread.
class StreamDecoder
{
public:
  virtual ~StreamDecoder() = default;
  StreamDecoder(const StreamDecoder&) = delete;
  StreamDecoder& operator=(const StreamDecoder&) = delete;

  struct Step
  {
    std::size_t Taken;
    std::size_t Written;
    bool Ended; ///< the stream, with its checksum; the next call begins another one
  };
  /// Unpacks as much of `in` as `out` has room for. Returns nothing when the stream is damaged.
  virtual std::optional<Step> Decode(
    const std::byte* in, std::size_t inBytes, std::byte* out, std::size_t outBytes) = 0;

  /// Unpacks a single stream to at most so many bytes. Returns nothing when it is damaged, or has more.
  static std::optional<ByteBuffer> DecodeWhole(
    StreamEncoding encoding, const ByteBuffer& stored, std::size_t most);

  /// Upper bound for the ratio of unpacked to packed bytes.
  static std::uint64_t GetMostGrowth(StreamEncoding encoding);
  /// Throws dsm::Error when this build does not have the library, and std::bad_alloc.
  static std::unique_ptr<StreamDecoder> Make(StreamEncoding encoding);

protected:
  StreamDecoder() = default;
};

} // namespace vol

#endif
