// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfChunkLayout_h
#define vol_HdfChunkLayout_h

#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/hdf/HdfBytes.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace vol
{

/// How an HDF5 dataset keeps where its chunks are, as the layout message of its object header says ("HDF5 File Format
/// Specification", IV.A.2.i).
struct HdfChunkLayout
{
  enum class Index
  {
    Tree1,           ///< B-tree, version 1: files of the earliest format
    Single,          ///< one chunk
    Implicit,        ///< all chunks, one behind the other
    FixedArray,      ///< no axis can grow
    ExtensibleArray, ///< one axis can grow without a limit
    Tree2            ///< B-tree, version 2: several can
  };
  Index Kind = Index::Tree1;
  std::uint64_t Address =
    HdfUndefined; ///< address of the index or of the chunks; undefined: no chunk is stored
  std::vector<std::uint64_t> Edges; ///< samples along each axis of a chunk, then bytes of a sample
  bool IsFiltered = false;          ///< for a single chunk: it is filtered, and has
  std::uint64_t SingleBytes = 0;    ///< so many bytes,
  std::uint32_t SingleSkippedFilters = 0; ///< without these filters (bits)

  /// `header`: place of the dataset's object header. Returns nothing where the header is damaged, or has another
  /// layout. Throws dsm::Error when the file cannot be read.
  static std::optional<HdfChunkLayout> Find(const PositionedFile& file, std::uint64_t header);
};

} // namespace vol

#endif
