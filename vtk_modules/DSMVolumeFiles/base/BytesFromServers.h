// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_BytesFromServers_h
#define vol_BytesFromServers_h

#include <atomic>
#include <cstdint>

namespace vol
{

/// Bytes of answers that servers have sent to this process.
inline std::atomic<std::uint64_t> BytesFromServers{ 0 };

} // namespace vol

#endif
