// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_BareFile_h
#define vol_BareFile_h

#include "DSMVolumeFiles/format/VolumeFile.h"

#include <cstdint>
#include <memory>
#include <string>

namespace vol
{

/// Description of the values of one array in a file: x fastest, uncompressed, contiguous.
struct BareValues
{
  std::string Path;
  std::string Name; ///< name of the array
  bricks::Index3 Samples{ 0 };
  bricks::ScalarType Type = bricks::ScalarType::UInt8;
  std::int64_t Components = 1; ///< as declared
  bool BigEndian = false;
  /// Before the first value; negative: the values are at the end of the file.
  std::int64_t Offset = 0;
  /// Smallest valid offset: the end of the header, if the file itself has one.
  std::int64_t Least = 0;
};

/// A volume of bare values, as a header elsewhere describes it. Its chunks are boxes of at
/// most 1 MiB. Throws dsm::Error when the file cannot be opened or is too short.
std::shared_ptr<VolumeFile> OpenBareFile(
  const std::string& path, const BareValues& values, const FileGeometry& geometry);

/// So many samples, of so many bytes, as boxes of at most 1 MiB: what is near in space is in few of them.
ChunkGrid CutIntoBoxes(const bricks::Index3& samples, std::size_t sampleBytes);
/// As rows that follow one another, or planes when a plane is small.
ChunkGrid CutIntoRows(const bricks::Index3& samples, std::size_t sampleBytes);

} // namespace vol

#endif
