// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfNotes_h
#define vol_HdfNotes_h

#include "DSMVolumeFiles/format/AxisNotes.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <string>
#include <vector>

namespace vol
{

/// What a file says of a dataset's axes: openPMD (1.0 and 1.1, meshes), EMD (dim1, dim2 ...), dimension scales (netCDF-4,
/// HDF5 Dimension Scale Specification), or attributes that have a voxel's size. Empty where it says nothing. What is not
/// honored becomes a sentence in `warnings`. The caller has GetHdfLock.
AxisNotes ReadHdfNotes(hid_t file, hid_t dataset, std::vector<std::string>& warnings);

} // namespace vol

#endif
