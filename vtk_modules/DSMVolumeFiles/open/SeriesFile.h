// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_SeriesFile_h
#define vol_SeriesFile_h

#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include <memory>
#include <string>
#include <vector>

namespace vol
{

/// Opens files as the time steps of one volume, in order; the first step of each is used. The first file is
/// opened at once, the others on demand; only the last few stay open. A file whose arrays, samples or chunks
/// differ from the first one's is rejected by name when it is opened. For a single path: OpenVolumeFile.
/// Throws dsm::Error.
std::shared_ptr<const VolumeFile> OpenVolumeSeries(
  const std::vector<std::string>& paths, const OpenOptions& options = {});

} // namespace vol

#endif
