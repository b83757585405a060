// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ZarrVector_h
#define vol_ZarrVector_h

#include <cstdint>
#include <string>
#include <vector>

namespace vol
{

class ZarrStore;

/// All numbers of the Zarr array of one axis in a folder, such as coordinates. None where there is no such array,
/// or it has more than `most` numbers, or shards. Throws dsm::Error when a chunk cannot be read.
std::vector<double> ReadZarrVector(
  const ZarrStore& store, const std::string& folder, std::uint64_t most);

} // namespace vol

#endif
