// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ImarisVolumes_h
#define vol_ImarisVolumes_h

#include "DSMVolumeFiles/hdf/HdfVolumes.h"

namespace vol
{

/// Places the volumes of an Imaris file (.ims) where its extents, which reach from edge to edge of
/// its voxels, say, and leaves out the samples by which its datasets are padded to whole chunks.
/// `isWhole`: the datasets were not chosen; those of the finest level become one array for each
/// channel, with a step for each time point. Changes nothing for other files. Under the lock.
void PlaceImaris(hid_t file, HdfVolumes& volumes, bool isWhole);

} // namespace vol

#endif
