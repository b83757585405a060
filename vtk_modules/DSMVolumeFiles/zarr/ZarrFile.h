// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrFile_h
#define vol_ZarrFile_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <memory>
#include <string>

namespace vol
{

/// Zarr, versions 2 and 3 (with sharding): one array, a group of arrays of one shape, or an
/// OME-Zarr image (https://ngff.openmicroscopy.org), of whose scales one is taken, with its
/// channels as arrays and its times as steps. `path` is a folder, which has one of these, or, where
/// options.Dataset is a path in it or the name of one of an image's "multiscales", several.
/// ZarrAxes finds the axes. `options`: also uses Level, and HasSpacing, with which the positions of
/// the samples are not read. Throws dsm::Error.
std::shared_ptr<VolumeFile> OpenZarr(const std::string& path, const OpenOptions& options);

} // namespace vol

#endif
