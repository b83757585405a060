// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_CacheFolder_h
#define vol_CacheFolder_h

#include <filesystem>

namespace vol
{

/// The user's folder for results that are kept: "dsm-ray-tracer" in $XDG_CACHE_HOME or ~/.cache, which may not
/// exist yet. Empty: there is none.
std::filesystem::path GetCacheFolder();

} // namespace vol

#endif
