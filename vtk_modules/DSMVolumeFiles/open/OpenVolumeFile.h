// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_OpenVolumeFile_h
#define vol_OpenVolumeFile_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <cstdint>
#include <memory>
#include <string>

namespace vol
{

/// Opens a file (or a folder: Zarr) of any format that this build knows. Throws dsm::Error, which says what is
/// wrong, or lists the formats there are.
std::shared_ptr<const VolumeFile> OpenVolumeFile(
  const std::string& path, const OpenOptions& options = {});

/// Differs when the contents do, also where a header stays as it is and the values beside it change; of files that
/// have values in them, nothing is read for it. Throws dsm::Error.
std::uint64_t FindStamp(const std::string& path, const OpenOptions& options = {});

/// Returns whether the file has bare values, so that OpenOptions::Raw has to describe them. Does not throw.
bool IsBareFile(const std::string& path);

/// Returns whether its name and first bytes look like one of the formats. Fast; does not throw.
bool MayBeVolumeFile(const std::string& path);

} // namespace vol

#endif
