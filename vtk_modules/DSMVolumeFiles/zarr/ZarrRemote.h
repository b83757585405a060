// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrRemote_h
#define vol_ZarrRemote_h

#include "DSMVolumeFiles/zarr/ZarrStore.h"

#include <memory>
#include <string>

namespace vol
{

/// A store that a server has. It cannot be listed, so groups need consolidated metadata. Throws dsm::Error, which names
/// the address, unless there is an array or a group.
std::shared_ptr<ZarrStore> MakeZarrRemote(const std::string& url, const OpenOptions& options);

} // namespace vol

#endif
