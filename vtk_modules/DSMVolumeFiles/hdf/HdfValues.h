// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfValues_h
#define vol_HdfValues_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ScalarType.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/hdf/HdfAxes.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

/// How the values of a dataset, or of one member of each, are stored.
struct HdfValues
{
  std::string Member; ///< of a compound type; empty: a value is one number
  bricks::ScalarType Type = bricks::ScalarType::UInt8; ///< as which they are shown
  bool Swapped = false;
  bool IsPlain = true; ///< else the library has to make that type of what is stored
};

/// Returns the value type of a dataset, or those of all members of its compound type that are
/// numbers; none where nothing is. Enumerations (truth values and the like) count as their numbers.
/// The caller of all of these has GetHdfLock.
std::vector<HdfValues> FindHdfValues(hid_t dataset);
/// The one of these with that member; nothing where there is none.
std::optional<HdfValues> FindHdfValues(hid_t dataset, const std::string& member);
/// The value type of a dataset that has other values than numbers, for messages: "opaque, 16
/// bytes".
std::string DescribeHdfType(hid_t dataset);

/// Returns the value of a sample that was never written.
std::vector<std::byte> GetHdfFill(hid_t dataset, bricks::ScalarType type, int components);

/// Reads the samples of a box, dense and x fastest, as numbers of `type`, by the library. `member`:
/// as HdfValues has it. `frame`: along the axis of time. Returns false, and `out` has zeros where
/// nothing was read, when the library cannot.
bool ReadHdfBox(hid_t dataset, bricks::ScalarType type, const std::string& member,
  const HdfAxes& axes, std::size_t frame, const bricks::Box& box, std::byte* out);

/// Converts the filters of a dataset with these properties to codec steps. Returns false if one is unknown.
bool FindHdfSteps(hid_t properties, std::vector<CodecStep>& steps);

/// Returns a message about a filter of a dataset that the library does not find; empty if it has all.
std::string FindLackingHdfFilter(hid_t dataset);

} // namespace vol

#endif
