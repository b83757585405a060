// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/base/CacheFolder.h"

#include <cstdlib>

namespace vol
{

std::filesystem::path GetCacheFolder()
{
  const char* const caches = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  const std::filesystem::path folder = caches && *caches ? std::filesystem::path(caches)
    : home && *home                                      ? std::filesystem::path(home) / ".cache"
                                                         : std::filesystem::path();
  return folder.empty() ? folder : folder / "dsm-ray-tracer";
}

} // namespace vol
