// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrMetadata_h
#define vol_ZarrMetadata_h

#include "DSMBricks/base/ScalarType.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

/// What the metadata of one Zarr array say, whichever version.
struct ZarrMetadata
{
  /// Chunks of a chunk, which share a file, behind or before an index of where they are.
  struct Sharding
  {
    std::vector<std::int64_t> ShardShape;
    ChunkCodec IndexCodec;
    std::size_t IndexBytes = 0; ///< as stored
    bool IndexIsFirst = false;
  };

  std::vector<std::int64_t> Shape; ///< the slowest axis first
  std::vector<std::int64_t> ChunkShape;
  nlohmann::json Axes; ///< their names, where these are told
  bricks::ScalarType Type = bricks::ScalarType::UInt8;
  std::vector<std::byte> Fill; ///< one value
  ChunkCodec Codec;
  bool FortranOrder = false; ///< within a chunk the first axis is the fastest
  std::optional<Sharding> Shards;
  /// Between the indices of a chunk, and before them.
  std::string Separator = ".";
  std::string Prefix;

  /// Whether it has samples, in chunks, no more along an axis than an int counts, and three to five axes.
  bool IsVolume() const;
};

/// Of the array in a folder; none where there is no array. Throws dsm::Error for what this build cannot read.
std::optional<ZarrMetadata> ReadZarrMetadata(const std::string& folder);

/// The attributes of an array or a group, which may be empty.
nlohmann::json ReadZarrAttributes(const std::string& folder);

} // namespace vol

#endif
