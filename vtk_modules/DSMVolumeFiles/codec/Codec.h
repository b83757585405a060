// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_Codec_h
#define vol_Codec_h

#include "DSMVolumeFiles/base/ByteBuffer.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace vol
{

/// A way to encode the bytes of a chunk. Each has a file of its own (ZstdCodec.cxx, ...) and a line in Codec.cxx; nothing
/// else lists them. The functions are for any thread.
struct Codec
{
  std::string_view Name;
  /// Zarr's names of it, where it needs nothing else to be known.
  std::vector<std::string_view> ZarrNames = {};
  int HdfFilter = 0; ///< HDF5's number; 0: it has none

  /// Package to install if this build lacks the library; empty if it has the library.
  std::string_view LackingPackage = {};

  bool IsCompressor = false;
  /// Upper bound for the ratio of decoded to encoded bytes.
  std::uint64_t MostGrowth = 1;
  /// Bytes that a codec that does not compress adds.
  std::size_t AddedBytes = 0;
  /// Each sample stays where it is, with its bytes in whatever order.
  bool KeepsPlaces = false;

  /// Returns at most `most` bytes. `width`: of an element. Throws dsm::Error, which begins with "its", when the bytes are
  /// damaged.
  ByteBuffer (*Decode)(ByteBuffer stored, std::size_t width, std::size_t most) = nullptr;
  /// Null: it is only read.
  ByteBuffer (*Encode)(ByteBuffer samples, std::size_t width) = nullptr;

  /// Adds the encoded halo behind an encoded chunk, where other programs do not look. Null: there is no such place.
  void (*AddHalo)(ByteBuffer& stored, const ByteBuffer& halo) = nullptr;
  /// Returns what AddHalo has added, or nothing.
  std::optional<ByteBuffer> (*FindHalo)(const ByteBuffer& stored) = nullptr;
};

/// All codecs, those included that this build lacks a library for.
const std::vector<Codec>& GetCodecs();
// These return null where there is none.
const Codec* FindCodec(std::string_view name);
const Codec* FindZarrCodec(std::string_view name);
const Codec* FindHdfCodec(int filter);

} // namespace vol

#endif
