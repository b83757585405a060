// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_NamedVectors_h
#define vol_NamedVectors_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <memory>

namespace vol
{

/// Offers three arrays that are components by name, such as E/x, E/y and E/z, as a vector E, too,
/// if they have one type and one grid. Vectors are behind all other arrays, and
/// FileArray::IsOffered. Returns the file itself where there are none.
std::shared_ptr<VolumeFile> OfferVectors(std::shared_ptr<VolumeFile> file);

} // namespace vol

#endif
