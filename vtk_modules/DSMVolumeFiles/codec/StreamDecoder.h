// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_StreamDecoder_h
#define vol_StreamDecoder_h

#include <cstddef>
#include <cstdint>
#include <memory>

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
  /// Unpacks as much of `in` as `out` has room for. Throws dsm::Error, which begins with "its", when the stream is
  /// damaged.
  virtual Step Decode(
    const std::byte* in, std::size_t inBytes, std::byte* out, std::size_t outBytes) = 0;

  /// Upper bound for the ratio of unpacked to packed bytes.
  static std::uint64_t GetMostGrowth(StreamEncoding encoding);
  /// Throws dsm::Error when this build does not have the library, and std::bad_alloc.
  static std::unique_ptr<StreamDecoder> Make(StreamEncoding encoding);

protected:
  StreamDecoder() = default;
};

} // namespace vol

#endif
