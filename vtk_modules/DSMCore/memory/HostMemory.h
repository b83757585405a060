// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_HostMemory_h
#define dsm_HostMemory_h

#include <cstdint>
#include <string>

namespace dsm
{

/// What the host, and the control group that the process is in, can still give without taking it
/// from running programs, swap of the host included; the largest number where the system does not
/// tell. Linux grants more than it has and later ends a process that uses it, so whoever wants to
/// fail with a message must ask before.
std::uint64_t GetAvailableHostMemory();

/// "12 MiB", rounded up.
std::string FormatMebibytes(std::uint64_t bytes);

} // namespace dsm

#endif
