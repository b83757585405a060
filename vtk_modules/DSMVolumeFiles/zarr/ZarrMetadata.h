// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrMetadata_h
#define vol_ZarrMetadata_h

#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/format/PackedValues.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

class ZarrStore;

/// Metadata of one Zarr array, of either version.
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
  PackedValues Packed;
  std::vector<std::byte> Fill; ///< one number, of chunks that are not stored
  nlohmann::json Attributes;
  ChunkCodec Codec;
  bool FortranOrder = false; ///< within a chunk the first axis is the fastest
  std::optional<Sharding> Shards;
  /// Between the indices of a chunk, and before them.
  std::string Separator = ".";
  std::string Prefix;

  /// Returns whether the array has samples, in chunks, at most as many along an axis as an int counts, and three to
  /// five axes.
  bool IsVolume() const;
  /// Returns the name, in the array's folder, of the file at a place along its axes: of a chunk, or of a shard.
  std::string GetKey(const std::int64_t* place) const;
  /// Files of chunks, or of shards, along each axis.
  std::vector<std::uint64_t> CountFiles() const;
};

/// Reads the metadata of the array in a folder; returns nothing if there is no array. Throws dsm::Error if this
/// build cannot read it.
std::optional<ZarrMetadata> ReadZarrMetadata(const ZarrStore& store, const std::string& folder);

/// The attributes of an array or a group, which may be empty.
nlohmann::json ReadZarrAttributes(const ZarrStore& store, const std::string& folder);

} // namespace vol

#endif
