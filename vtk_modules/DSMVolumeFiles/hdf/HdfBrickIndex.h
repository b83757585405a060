// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfBrickIndex_h
#define vol_HdfBrickIndex_h

#include "DSMVolumeFiles/format/VolumeFile.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <cstdint>

namespace vol
{

/// The group in which a brick file (BrickFileWriter) has more of an array than its values; not open where there is
/// none. `root`: of the file, or of a coarser level. The caller has GetHdfLock, here and below.
HdfHandle OpenHdfBrickIndex(hid_t root, const FileArray& array);

/// Reads the index from that group. Returns an empty index if there is none, or if a part is too large for a file
/// of `fileBytes` bytes.
VolumeFile::Index ReadHdfBrickIndex(hid_t root, const FileArray& array, std::uint64_t fileBytes);

} // namespace vol

#endif
