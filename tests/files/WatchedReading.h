// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_files_WatchedReading_h
#define tests_files_WatchedReading_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>

/// Reads files that nobody should trust, and watches what that costs.
namespace dsm_test
{

namespace fs = std::filesystem;

/// A new and empty folder for a test's files.
fs::path MakeFolder(const std::string& name);

void WriteText(const fs::path& path, const std::string& text);
/// Writes a file of zeros that takes no space on the disk.
void WriteSparse(const fs::path& path, std::uintmax_t bytes);

/// Opens a file and reads the first chunk of each of its arrays. Returns what goes wrong; empty where nothing does.
/// Fails the test where it takes a second of the processor, or 100 MB more memory than before.
std::string ReadWatched(const fs::path& path, const vol::OpenOptions& options = {});

/// Expects that ReadWatched refuses a file, and that the error has its path and all of these words.
void ExpectRefusal(const fs::path& path, std::initializer_list<const char*> words,
  const vol::OpenOptions& options = {});

} // namespace dsm_test

#endif
