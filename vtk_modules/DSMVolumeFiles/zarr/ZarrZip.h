// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrZip_h
#define vol_ZarrZip_h

#include "DSMVolumeFiles/zarr/ZarrStore.h"

#include <memory>
#include <string>

namespace vol
{

/// A ZIP archive of a Zarr folder, as OME's .ozx: of what is in the folder, or of the folder itself. Throws dsm::Error,
/// which names the archive, where it has none.
std::shared_ptr<ZarrStore> MakeZarrZip(const std::string& path);

} // namespace vol

#endif
