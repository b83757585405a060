// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ChunkCodec_h
#define vol_ChunkCodec_h

#include "DSMVolumeFiles/base/ByteBuffer.h"
#include "DSMVolumeFiles/codec/Codec.h"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace vol
{

/// One step of how the bytes of a chunk were made out of its samples.
struct CodecStep
{
  /// The name must be a codec's.
  CodecStep(std::string_view name, std::size_t width = 1);
  /// Not null.
  explicit CodecStep(const Codec* what, CodecParameters with = {});

  const Codec* What;
  CodecParameters With;
};

/// Turns the bytes of a chunk as a file has them into samples, and back. Any thread.
class ChunkCodec
{
public:
  /// Throws dsm::Error, without a name, when this build has no library for a step, when there are more steps or
  /// compressors than FileLimits has, or when a step has no width.
  explicit ChunkCodec(std::vector<CodecStep> steps = {});

  /// Undoes the steps, the last one first, and writes so many bytes; `skipped` has a bit for each step that was
  /// left out for this chunk. Throws dsm::Error, without the chunk's name, when the bytes are not what the steps
  /// make, or not so many. `halo`: so many bytes as were given to Encode; null where they are not wanted. False
  /// when the chunk has no halo, or not so many bytes; then nothing is written.
  bool Decode(ByteBuffer stored, unsigned skipped, std::byte* out, std::size_t bytes,
    ByteBuffer* halo = nullptr) const;

  /// Returns the stored bytes of these samples: applies all steps, the first one first. Throws dsm::Error for
  /// codecs that this build only reads. `halo`: further samples, for Decode. They lie behind the end of the
  /// compressed data, so other programs skip them: in a skippable frame for Zstandard (RFC 8878, section 3.1.2),
  /// behind the end of the stream for deflate (RFC 1950). Only if KeepsHalo().
  ByteBuffer Encode(ByteBuffer samples, ByteBuffer halo = {}) const;

  /// Returns an upper bound for the stored size of a chunk and its halo. A stored chunk that is larger is damaged.
  /// Saturates.
  std::uint64_t CountMostStored(std::uint64_t bytes, std::uint64_t haloBytes = 0) const;
  /// Returns an upper bound for the size that a chunk of this stored size can unpack to. Saturates.
  std::uint64_t CountMostDecoded(std::uint64_t stored) const;

  /// Returns whether a halo can be stored: behind a Zstandard frame or a deflate stream, if it is the only
  /// compressor.
  bool KeepsHalo() const;

  bool IsPlain() const { return this->Steps.empty(); }
  /// Returns whether each sample is at the same offset as in plain data, in any byte order, so that any of them can
  /// be decoded alone.
  bool KeepsPlaces() const;

private:
  std::vector<CodecStep> Steps;
};

} // namespace vol

#endif
