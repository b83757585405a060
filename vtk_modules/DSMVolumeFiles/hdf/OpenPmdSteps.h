// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_OpenPmdSteps_h
#define vol_OpenPmdSteps_h

#include "DSMVolumeFiles/hdf/HdfVolumes.h"

namespace vol
{

/// Makes one volume of the meshes that have one name in all iterations of an openPMD file (standard 1.1,
/// "Iterations and Time Series"). It has a dataset for each step, and the name of the mesh in an iteration, such as
/// "E/x". Sets the times of `volumes`, in seconds. A mesh that is not in all iterations is left out, with a
/// sentence in its warnings. Nothing changes in other files. The caller has GetHdfLock.
void JoinOpenPmdSteps(hid_t file, HdfVolumes& volumes);

} // namespace vol

#endif
