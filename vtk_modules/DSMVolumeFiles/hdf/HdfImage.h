// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfImage_h
#define vol_HdfImage_h

#include "DSMVolumeFiles/format/VolumeFile.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <string>
#include <vector>

namespace vol
{

/// Description of the image in the VTKHDF group of an HDF5 file ("VTKHDF File Format", ImageData).
struct HdfImage
{
  FileGeometry Geometry;
  std::vector<double> Times; ///< times of the steps, ascending; empty if there are no steps

  /// `group`: VTKHDF. Throws dsm::Error, which names the file at `path`. The caller has GetHdfLock.
  static HdfImage Read(hid_t group, const std::string& path);
};

} // namespace vol

#endif
