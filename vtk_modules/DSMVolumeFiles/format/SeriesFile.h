// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_SeriesFile_h
#define vol_SeriesFile_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <memory>
#include <string>
#include <vector>

namespace vol
{

/// Files that are the time steps of one volume, in order; of each the first step counts. The first is opened, the
/// others when something of them is wanted, and only the last few stay open. What does not have the first one's
/// arrays, samples and chunks is refused, by its name, when it is opened. Of one path: OpenVolumeFile. Throws
/// dsm::Error.
std::shared_ptr<const VolumeFile> OpenVolumeSeries(
  const std::vector<std::string>& paths, const OpenOptions& options = {});

} // namespace vol

#endif
