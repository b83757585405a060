// SPDX-License-Identifier: BSD-3-Clause
#ifndef fuzz_VolumeCheck_h
#define fuzz_VolumeCheck_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <filesystem>

namespace fuzz
{

/// Opens a file that may contain anything, reads everything that the interface offers, and checks what must hold for
/// every file:
/// - only dsm::Error is thrown, and its text names the file, or another one in the same folder;
/// - the arrays, steps and times agree with the contract of vol::VolumeFile;
/// - reading a chunk sets all of its bytes, and no others; a part or a chunk with its halo has the same values.
/// A violation ends the process (Fail). Chunks of more than 4 MiB are not read.
/// Returns the file's levels of detail; 0: it was refused.
int CheckVolume(const std::filesystem::path& path, const vol::OpenOptions& options = {});

/// CheckVolume of the finest level, and of the coarsest one where there are several.
void CheckLevels(const std::filesystem::path& path);

} // namespace fuzz

#endif
