// SPDX-License-Identifier: BSD-3-Clause
#ifndef fuzz_InputFolder_h
#define fuzz_InputFolder_h

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace fuzz
{

/// The folder of a fuzz target's input files: in memory where the system has /dev/shm, one for each process,
/// removed when the process ends normally. The first call also removes folders of processes that crashed. Forked
/// processes share the folder of their parent.
const std::filesystem::path& GetInputFolder();

/// Writes a file of the folder, or of a folder in it that exists; ends the process when that fails.
void WriteInput(const std::filesystem::path& path, const std::uint8_t* bytes, std::size_t count);

/// Ends the process by SIGABRT after printing `what`: the input is a finding.
[[noreturn]] void Fail(const std::string& what);

} // namespace fuzz

#endif
