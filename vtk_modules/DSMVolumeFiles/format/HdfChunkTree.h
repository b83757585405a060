// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfChunkTree_h
#define vol_HdfChunkTree_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMVolumeFiles/base/PositionedFile.h"

#include <cstdint>
#include <vector>

namespace vol
{

/// Where a chunk of an HDF5 dataset is in the file.
struct HdfChunk
{
  static constexpr std::uint64_t Nowhere = UINT64_MAX;

  std::uint64_t First = Nowhere;
  std::uint32_t Bytes = 0;
  std::uint32_t SkippedFilters = 0; ///< bits
};

/// Reads the tree in which HDF5 keeps where a dataset's chunks are ("HDF5 File Format Specification", III.A.1, version
/// 1: what its library writes unless it is told not to). The library itself (1.10, 1.12) goes through the whole
/// tree for each chunk that it is asked for, which takes hours where there are a million.
class HdfChunkTree
{
public:
  /// First sample of a chunk, along each of the dataset's axes, slowest first; and where it is.
  using Visit = dsm::FunctionRef<void(const std::uint64_t* first, const HdfChunk& chunk)>;

  /// `header`: place of the dataset's object header in the file. Tells each chunk that is there, in no order. False
  /// where the file keeps chunks in another way, or is not as it should be: then what was told counts for
  /// nothing. Throws dsm::Error when the file cannot be read.
  static bool Read(
    const PositionedFile& file, std::uint64_t header, std::size_t axes, const Visit& visit);
};

} // namespace vol

#endif
