// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_Codec_h
#define vol_Codec_h

#include "DSMBricks/base/ScalarType.h"
#include "DSMVolumeFiles/base/ByteBuffer.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vol
{

/// How an element is stored.
struct ElementType
{
  bricks::ScalarType Type = bricks::ScalarType::UInt8;
  bool Swapped = false; ///< the other byte order than the machine's
};

/// Parameters with which a codec encodes or decodes a chunk. Plain.
struct CodecParameters
{
  std::size_t Width = 1; ///< bytes of an element
  // Types before and after encoding, scale and offset, of codecs that convert numbers.
  ElementType Decoded = {};
  ElementType Encoded = {};
  double Scale = 1.0;
  double Offset = 0.0;
  /// Further numbers, whose meaning the codec's file says.
  std::vector<std::uint64_t> Numbers = {};
};

/// A way to encode the bytes of a chunk. Each has a file of its own (ZstdCodec.cxx, ...) and a line in VOL_CODECS;
/// nothing else lists them. The functions are for any thread.
struct Codec
{
  std::string_view Name;
  /// Zarr's names of it: the "id" of version 2. Version 3 has them as they are, or after "numcodecs.".
  std::vector<std::string_view> ZarrNames = {};
  std::vector<int> HdfFilters = {}; ///< HDF5's numbers of it

  /// Package to install if this build does not have the library; else empty.
  std::string_view LackingPackage = {};

  bool IsCompressor = false;
  /// Upper bound for the ratio of decoded to encoded bytes.
  std::uint64_t MostGrowth = 1;
  /// Each element becomes one of CodecParameters::Encoded.
  bool ConvertsNumbers = false;
  /// Bytes that a codec that does not compress adds.
  std::size_t AddedBytes = 0;
  /// Each sample stays where it is, with its bytes in whatever order.
  bool KeepsPlaces = false;

  /// Returns the parameters that Zarr's metadata have. `configuration`: in version 2 the object with the "id";
  /// `decoded`: the type of the array where the metadata do not name one. Throws dsm::Error, which names the member
  /// that is invalid. Null: it has none.
  CodecParameters (*ParseZarr)(
    const nlohmann::json& configuration, const ElementType& decoded) = nullptr;
  /// Returns at most `most` bytes. Throws dsm::Error, which begins with "its", when the bytes are damaged.
  ByteBuffer (*Decode)(ByteBuffer stored, const CodecParameters& with, std::size_t most) = nullptr;
  /// Null for a codec that can only decode.
  ByteBuffer (*Encode)(ByteBuffer samples, const CodecParameters& with) = nullptr;

  /// Adds the encoded halo behind an encoded chunk, where other programs do not look. Null: there is no such place.
  void (*AddHalo)(ByteBuffer& stored, const ByteBuffer& halo) = nullptr;
  /// Returns what AddHalo has added, or nothing.
  std::optional<ByteBuffer> (*FindHalo)(const ByteBuffer& stored) = nullptr;
};

/// All codecs: a static library keeps what is named here. `codec(Name)` stands for MakeNameCodec.
#define VOL_CODECS(codec)                                                                          \
  codec(Swap) codec(Shuffle) codec(Deflate) codec(Blosc) codec(Zstd) codec(Fletcher32)             \
    codec(Crc32c) codec(Bzip2) codec(Lz4) codec(HdfLz4) codec(Lzma) codec(Rounded) codec(AsType)   \
      codec(Delta) codec(FixedScaleOffset)
#define VOL_DECLARE_CODEC(name) Codec Make##name##Codec();
VOL_CODECS(VOL_DECLARE_CODEC)
#undef VOL_DECLARE_CODEC

/// All codecs, including those for which this build has no library.
const std::vector<Codec>& GetCodecs();
// These return null where there is none.
const Codec* FindCodec(std::string_view name);
const Codec* FindZarrCodec(std::string_view name);
const Codec* FindHdfCodec(int filter);
/// Returns Zarr's names of all codecs, for messages: "blosc, bz2, ...".
std::string ListZarrCodecs();

} // namespace vol

#endif
