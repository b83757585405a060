// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_UnpackedCopy_h
#define vol_UnpackedCopy_h

#include "DSMVolumeFiles/codec/StreamDecoder.h"
#include "DSMVolumeFiles/plain/ValueBytes.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace vol
{

/// Values of an array that are compressed in one piece, or in several files of equally many values.
struct CompressedValues
{
  struct Part
  {
    ValuePart Place;           ///< where the compressed bytes begin
    std::uint64_t PackedBytes; ///< at most so many of them
  };
  std::vector<Part> Parts;
  StreamEncoding Encoding = StreamEncoding::Deflate;
  std::uint64_t PartBytes = 0; ///< of the values in each part
  /// Unpacked bytes before the values; -1: the values end the unpacked bytes.
  std::int64_t Skip = 0;
};

/// Returns a file in the cache folder (GetCacheFolder) that has these values, part behind part, for reading in
/// parts. Unpacks them to it, unless that has been done and the packed files are unchanged: of several processes
/// one does so while others wait. A copy takes at most half of what is free on the disk; older copies are removed
/// for it, and processes that have them open keep them. Memory: about 2 MiB. `goesOn`: as OpenOptions::GoesOn.
///
/// Throws dsm::Error, which names the file, where the unpacked bytes are not as many as expected or damaged, or
/// there is no room.
ValuePart UnpackOnce(const CompressedValues& packed, const std::function<bool()>& goesOn);

} // namespace vol

#endif
