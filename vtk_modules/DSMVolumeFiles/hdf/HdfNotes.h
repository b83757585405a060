// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfNotes_h
#define vol_HdfNotes_h

#include "DSMVolumeFiles/format/AxisNotes.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <string>
#include <vector>

namespace vol
{

/// Reads a file's notes on a dataset's axes: openPMD (1.0 and 1.1, meshes), EMD (dim1, dim2 ...), dimension scales
/// (netCDF-4, HDF5 Dimension Scale Specification), or attributes that have a voxel's size. Empty if there are none.
/// Adds a sentence to `warnings` for each note that is not honored. The caller has GetHdfLock.
AxisNotes ReadHdfNotes(hid_t file, hid_t dataset, std::vector<std::string>& warnings);

} // namespace vol

#endif
