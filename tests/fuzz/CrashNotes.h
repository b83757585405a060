// SPDX-License-Identifier: BSD-3-Clause
#ifndef fuzz_CrashNotes_h
#define fuzz_CrashNotes_h

#include <cstddef>

namespace fuzz
{

/// How a process ends whose input makes the HDF5 library crash, not the project. The targets go on after such
/// inputs, and count them.
constexpr int EndedInLibrary = 76;

/// From now on, a signal such as SIGSEGV or SIGABRT prints the stack. Where the innermost function that is not one
/// of the C or C++ library is libhdf5's, the process ends with `codeForLibrary`; else as it would have without.
void InstallCrashNotes(int codeForLibrary);

/// Ends the process with `codeForLibrary` after printing what the HDF5 library did wrong.
[[noreturn]] void BlameLibrary(const char* what);

/// From now on, an allocation of more bytes ends the process by SIGABRT, whatever library asks for it. libhdf5 gets
/// nothing then, and goes on; with a sanitizer, the process ends with `codeForLibrary`.
void LimitAllocations(std::size_t bytes);

/// The process ends by SIGABRT when it has used so many seconds of processor time from now, or when ten times as many
/// seconds have passed. Other work on the machine does not change the first limit. 0 sets no limit. The process ends
/// with `codeForLibrary` if it is in a function of libhdf5 that is known not to end for some files.
void LimitTime(unsigned seconds);

} // namespace fuzz

#endif
