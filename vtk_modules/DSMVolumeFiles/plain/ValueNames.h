// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_ValueNames_h
#define vol_ValueNames_h

#include "DSMVolumeFiles/plain/HeaderText.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vol
{

/// Returns whether a field says that names of files follow: "LIST", "LIST 2".
bool IsList(const std::string& place);

/// Returns the paths of the files that the field `name` of a header names for its values, from the header's folder on,
/// in the order of the values, all of which have equally many. The field is a file's name, or
/// - "LIST", where the names are in the header's next lines;
/// - a pattern with a first and a last number, and a step unless that is 1 ("a%03d.raw 1 9 2"), unless a file is called
///   so. A percent sign without numbers behind the name is a part of the name.
/// After either, "2" or "2D" says how many of the array's axes each file has; usually these are all but the last
/// one. `sizes`: samples along the array's axes, the fastest first. Throws dsm::Error if the number of files
/// differs from that of the sizes, or exceeds FileLimits::Sources.
std::vector<std::string> FindValueFiles(const HeaderText& header, const std::string& name,
  HeaderLines& lines, const std::vector<std::int64_t>& sizes);

} // namespace vol

#endif
