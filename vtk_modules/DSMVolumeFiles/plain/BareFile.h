// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_BareFile_h
#define vol_BareFile_h

#include "DSMVolumeFiles/codec/StreamDecoder.h"
#include "DSMVolumeFiles/format/VolumeFile.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vol
{

/// Description of the values of one array in a file, or in several that have equally many: x fastest, contiguous.
struct BareValues
{
  std::vector<std::string> Paths; ///< in the order of the values
  std::string Name;               ///< name of the array
  bricks::Index3 Samples{ 0 };
  bricks::ScalarType Type = bricks::ScalarType::UInt8;
  std::int64_t Components = 1; ///< as declared
  /// All samples of a component follow one another; else the components of a sample do.
  bool ComponentsApart = false;
  bool BigEndian = false;
  /// Bytes of each file before its first value, or its first compressed byte. Negative: the values end the file.
  std::int64_t Offset = 0;
  /// Lines of text in each file that the offset counts from.
  std::int64_t Lines = 0;
  /// Smallest valid offset: the end of the header, if the file itself has one.
  std::int64_t Least = 0;
  StreamEncoding Encoding = StreamEncoding::Plain;
  /// The number of unpacked bytes before the values of each compressed file, or -1 (CompressedValues::Skip).
  std::int64_t Skip = 0;
  /// Compressed bytes in each file; 0: all that follow.
  std::int64_t PackedBytes = 0;
  std::vector<std::string> Warnings; ///< VolumeFile::GetWarnings
};

/// A volume of bare values, as a header elsewhere describes it. Its chunks are boxes of at most 1 MiB. Compressed
/// values are unpacked once (UnpackOnce), unless OpenOptions::OnlyHeader is set. Throws dsm::Error when a file
/// cannot be opened or is too short.
std::shared_ptr<VolumeFile> OpenBareFile(const std::string& path, const BareValues& values,
  const FileGeometry& geometry, const OpenOptions& options);

} // namespace vol

#endif
