// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_Url_h
#define vol_Url_h

#include <string>

namespace vol
{

/// Returns whether a name is an address, such as "https://host/image.zarr", and not a path of the file system.
bool IsUrl(const std::string& name);

/// Returns an address for messages: without what may be a password, before an '@' or behind a '?'.
std::string HideCredentials(const std::string& name);

/// Returns a path that is the same for all processes, whatever folder they are in. Addresses stay as they are.
std::string GetWholePath(const std::string& path);

} // namespace vol

#endif
