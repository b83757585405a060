// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HeaderFiles_h
#define vol_HeaderFiles_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <memory>
#include <string>

namespace vol
{

/// Teem's NRRD (https://teem.sourceforge.net/nrrd/format.html), versions 1 to 5, encodings raw, gzip and bzip2:
/// values behind the header or in one or several other files; three axes, or four of which the first or last one
/// has the components. World space is left-posterior-superior where `space` is one of the anatomical spaces, else
/// as it is.
std::shared_ptr<VolumeFile> OpenNrrd(const std::string& path, const OpenOptions& options);

/// ITK's MetaImage (.mhd, .mha) of three dimensions, compressed or not, in one or several files.
std::shared_ptr<VolumeFile> OpenMetaImage(const std::string& path, const OpenOptions& options);

} // namespace vol

#endif
