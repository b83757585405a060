// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrSource_h
#define vol_ZarrSource_h

#include "DSMVolumeFiles/zarr/ZarrAxes.h"
#include "DSMVolumeFiles/zarr/ZarrListing.h"
#include "DSMVolumeFiles/zarr/ZarrMetadata.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vol
{

/// Origin of an array of a volume: a Zarr array, or a channel of one.
struct ZarrSource
{
  using Index = ZarrListing::Index; ///< of a chunk, or of a file

  std::string Folder;
  std::shared_ptr<const ZarrMetadata> Data;
  ZarrAxes Axes;
  std::vector<std::int64_t> Channel; ///< along the leading axes; of time, 0
  ZarrListing* Listing;              ///< not owned

  /// `slice`: which one of the times and channels in the chunk.
  Index FindIndex(int step, const bricks::Index3& chunk, std::size_t* slice = nullptr) const;
  /// Which file, or shard, has a chunk.
  Index GetFileIndex(Index index) const;
};

} // namespace vol

#endif
