// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_HostMemory_h
#define dsm_HostMemory_h

#include <cstdint>
#include <string>

namespace dsm
{

/// Returns the bytes that the host, and the control group of the process, can still provide without
/// taking memory from running programs; the host's swap is included. Returns the largest number if
/// the system does not report it. Linux grants more memory than it has and later kills a process
/// that uses it, so code that must fail with a message has to ask first.
std::uint64_t GetAvailableHostMemory();

/// "12 MiB", rounded up.
std::string FormatMebibytes(std::uint64_t bytes);

} // namespace dsm

#endif
