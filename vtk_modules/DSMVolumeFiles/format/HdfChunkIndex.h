// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfChunkIndex_h
#define vol_HdfChunkIndex_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/format/HdfChunkLayout.h"

#include <cstdint>
#include <vector>

namespace vol
{

/// Place of a chunk of an HDF5 dataset in the file.
struct HdfChunk
{
  std::uint64_t First = 0;
  std::uint32_t Bytes = 0;
  std::uint32_t SkippedFilters = 0; ///< bits
};

/// Reads the index in which an HDF5 file keeps where a dataset's chunks are, of each kind that its library writes
/// ("HDF5 File Format Specification", III.A.1 and III.A.2, and appendix C; version 3). The library itself (1.10,
/// 1.12) goes through the whole index for each chunk that it is asked for, which takes hours where there are a
/// million.
///
/// Nothing of the file is trusted: no byte is read twice, so that nodes that lead to one another end; every block
/// has to have its signature, version, size and, in the newer kinds, its checksum.
class HdfChunkIndex
{
public:
  /// Number of a chunk along each of the dataset's axes, slowest first; and where it is. Returns false to stop.
  using Visit = dsm::FunctionRef<bool(const std::uint64_t* place, const HdfChunk& chunk)>;

  /// `most`: samples that the dataset may grow to along each axis, UINT64_MAX for any number. Visits each chunk that is
  /// there, in no order. Returns false where the index is damaged, of another kind, or the visit stopped it: then
  /// what was visited counts for nothing. Throws dsm::Error when the file cannot be read.
  static bool Read(const PositionedFile& file, const HdfChunkLayout& layout,
    const std::vector<std::uint64_t>& most, const Visit& visit);
};

} // namespace vol

#endif
