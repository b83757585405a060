// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrNotes_h
#define vol_ZarrNotes_h

#include "DSMVolumeFiles/format/AxisNotes.h"
#include "DSMVolumeFiles/zarr/ZarrAxes.h"
#include "DSMVolumeFiles/zarr/ZarrMetadata.h"
#include "DSMVolumeFiles/zarr/ZarrStore.h"

#include <string>
#include <vector>

namespace vol
{

/// The names of an array's axes, where it tells them. `folder`: the array's. Throws dsm::Error, which names it,
/// where a name is too long.
AxisNotes NameZarrAxes(const std::string& folder, const ZarrMetadata& data);

/// Reads the notes on the axes of the array in a folder: its own, and those of the arrays beside it that have the
/// names of its axes.
AxisNotes ReadZarrNotes(const ZarrStore& store, const std::string& folder, const ZarrMetadata& data,
  const ZarrAxes& axes);

/// Adds a sentence to `warnings` for each place that is not along the array's axes.
void WarnOfZarrPlaces(const ZarrStore& store, const std::string& folder, const ZarrMetadata& data,
  std::vector<std::string>& warnings);

} // namespace vol

#endif
