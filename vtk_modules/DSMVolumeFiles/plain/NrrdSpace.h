// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_NrrdSpace_h
#define vol_NrrdSpace_h

#include "DSMVolumeFiles/format/VolumeFile.h"
#include "DSMVolumeFiles/plain/HeaderText.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vol
{

/// Returns the vectors of a field, such as "(1, 0, 0) (0,1,0) none"; an axis without one has no numbers. Throws
/// dsm::Error.
std::vector<std::vector<double>> ParseNrrdVectors(
  const HeaderText& header, const std::string& name);

/// Places the samples of a NRRD file in the world: left-posterior-superior where `space` is one of the anatomical
/// spaces, else as it is. `domain`: which of the file's axes are x, y and z of the samples. Adds to `warnings`
/// where the space is not honored. Throws dsm::Error.
FileGeometry PlaceNrrd(const HeaderText& header, const std::vector<std::size_t>& domain,
  const bricks::Index3& samples, std::vector<std::string>& warnings);

} // namespace vol

#endif
