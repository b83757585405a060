// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfChunks_h
#define vol_HdfChunks_h

#include "DSMVolumeFiles/format/VolumeFile.h"
#include "DSMVolumeFiles/hdf/HdfAxes.h"
#include "DSMVolumeFiles/hdf/HdfChunkTable.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

/// The samples along each axis of a dataset's chunks, slowest axis first. Throws dsm::Error, which names the file
/// and the dataset, if the chunks have no samples, or more or fewer axes than the dataset: then the library would
/// write outside of the given memory. The caller has GetHdfLock, here and below.
std::vector<hsize_t> GetHdfChunkEdges(
  hid_t dataset, const std::string& path, const std::string& name);

/// Returns the offset of the values of a contiguous dataset; HADDR_UNDEF if none have been written.
/// `slices`: boxes of samples along its axes that are not in space. Throws dsm::Error if the file
/// ends before the values do.
haddr_t FindHdfValuesPlace(
  hid_t dataset, const PositionedFile& file, const FileArray& array, std::uint64_t slices);

/// Throws dsm::Error where a dataset whose values are in one piece, or in its header, has fewer of
/// them than its shape says: the library would read beyond them.
void CheckHdfStored(hid_t dataset, const std::string& path, const std::string& name);

/// Reads the places of the chunks of a dataset that have samples of a volume with these axes.
/// Returns nothing if the file has an index of another kind, or addresses of another size: then
/// only the library can read the values. Throws dsm::Error if the index is damaged, or if `goesOn`,
/// which is called now and then, returns false.
std::optional<HdfChunkTable> FindHdfChunks(hid_t dataset, const PositionedFile& file,
  const std::string& name, const std::vector<hsize_t>& edges, const HdfAxes& axes,
  const std::function<bool()>& goesOn);

} // namespace vol

#endif
