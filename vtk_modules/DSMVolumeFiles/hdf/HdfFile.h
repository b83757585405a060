// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfFile_h
#define vol_HdfFile_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <memory>
#include <string>

namespace vol
{

/// HDF5: VTK's ImageData (VTKHDF), or datasets of three axes (z, y, x), more with time first or components last.
/// The index of a dataset's chunks is read when the file is opened; chunks are then read without the library.
/// Datasets whose values are neither contiguous nor in chunks with filters that are known here are read by the
/// library. A brick file (BrickFileWriter) may have coarser levels, from 1 on. `options`: Level, Dataset and GoesOn
/// count. Throws dsm::Error.
std::shared_ptr<VolumeFile> OpenHdf(const std::string& path, const OpenOptions& options = {});

} // namespace vol

#endif
