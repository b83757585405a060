// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HeaderFiles_h
#define vol_HeaderFiles_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <memory>
#include <string>

namespace vol
{

/// Teem's NRRD (https://teem.sourceforge.net/nrrd/format.html), versions 1 to 5, encoding raw: values behind the
/// header or in a file of their own; three axes, or four of which the first one has the components.
std::shared_ptr<VolumeFile> OpenNrrd(const std::string& path);

/// ITK's MetaImage (.mhd, .mha), not compressed, of three dimensions.
std::shared_ptr<VolumeFile> OpenMetaImage(const std::string& path);

} // namespace vol

#endif
