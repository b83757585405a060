// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfChunks_h
#define vol_HdfChunks_h

#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/format/HdfChunkTree.h"
#include "DSMVolumeFiles/format/HdfLibrary.h"

#include <vector>

namespace vol
{

/// The samples of a chunk along each axis of a dataset with these properties, of five at most. With the library's lock
/// held.
std::vector<hsize_t> GetHdfChunkEdges(hid_t properties);

/// Where the chunks of a dataset are, the last axis' fastest; with the library's lock held. `edges`: samples of a
/// chunk along each axis of the dataset. `file` is the same as the dataset's. Throws dsm::Error when it does not
/// tell.
std::vector<HdfChunk> FindHdfChunks(
  hid_t dataset, const PositionedFile& file, const std::vector<hsize_t>& edges);

} // namespace vol

#endif
