// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrParts_h
#define vol_ZarrParts_h

#include "DSMVolumeFiles/base/ByteSource.h"
#include "DSMVolumeFiles/zarr/ZarrMetadata.h"

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

namespace vol
{

/// Cached data about the files in a Zarr folder, which are opened again for each chunk: their stamps, and the
/// indices of shards, up to some megabytes of either. Any thread.
class ZarrParts
{
public:
  /// Offsets and lengths of the chunks in a shard.
  using Index = std::shared_ptr<const std::vector<std::uint64_t>>;

  /// Throws dsm::Error when the file was written to, or another took its place, since it was opened first: what was
  /// read of it must not meet other values.
  void CheckUnchanged(const StampedSource& file);
  /// Throws dsm::Error when there was a file that is no longer there: what chunks without one have is not its.
  void CheckNeverThere(const std::string& path);
  /// Returns the index of an unchanged file. Throws dsm::Error when it is truncated or damaged.
  Index GetIndex(const ZarrMetadata::Sharding& shards, const StampedSource& file);

  /// Returns an upper bound of the memory in bytes for so many files.
  static std::uint64_t CountBytes(std::uint64_t files, std::uint64_t indexBytes);

private:
  struct Entry
  {
    std::string Path;
    Index Offsets;
  };

  static Index ReadIndex(const ZarrMetadata::Sharding& shards, const StampedSource& file);

  std::mutex Guard;
  std::unordered_map<std::string, std::uint64_t> Stamps; ///< by path
  std::size_t IndexBytes = 0;
  std::list<Entry> Order; ///< the last used first
  std::unordered_map<std::string, std::list<Entry>::iterator> Indices;
};

} // namespace vol

#endif
