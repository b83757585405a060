// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_Checksums_h
#define vol_Checksums_h

#include <cstddef>
#include <cstdint>

namespace vol
{

/// Fletcher's checksum over words of 16 bits, the high byte first, as HDF5 has it (HDF5 File Format
/// Specification, "fletcher32 filter").
std::uint32_t GetFletcher32(const std::byte* bytes, std::size_t count);

/// CRC-32C (Castagnoli), RFC 3720 appendix B.4.
std::uint32_t GetCrc32c(const std::byte* bytes, std::size_t count);

/// Bob Jenkins' lookup3 (hashlittle, 2006), which HDF5 has behind its own structures.
std::uint32_t GetLookup3(const std::byte* bytes, std::size_t count);

} // namespace vol

#endif
