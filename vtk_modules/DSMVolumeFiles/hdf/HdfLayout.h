// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfLayout_h
#define vol_HdfLayout_h

#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/codec/ChunkCodec.h"
#include "DSMVolumeFiles/format/ChunkStorage.h"
#include "DSMVolumeFiles/format/VolumeFile.h"
#include "DSMVolumeFiles/hdf/HdfAxes.h"
#include "DSMVolumeFiles/hdf/HdfChunkTable.h"
#include "DSMVolumeFiles/hdf/HdfLibrary.h"
#include "DSMVolumeFiles/hdf/HdfOrigins.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vol
{

/// A dataset, and where its values are.
struct HdfDataset
{
  HdfHandle Id;
  bricks::ScalarType Type = bricks::ScalarType::UInt8; ///< as which the library reads it
  bool ReadByLibrary = false;
  haddr_t First = HADDR_UNDEF;         ///< of contiguous values
  std::optional<HdfChunkTable> Chunks; ///< chunks of all times; none where values are contiguous
  std::vector<hsize_t> Edges;          ///< of a chunk, along all axes
  HdfAxes Shape;
  std::string Member; ///< see HdfValues
  std::vector<int>
    Frames; ///< position of each step along the time axis; empty: each step has its own chunks

  std::size_t GetFrame(int step) const
  {
    return this->Shape.Frames == 0
      ? 0
      : static_cast<std::size_t>(
          this->Frames.empty() ? step : this->Frames[static_cast<std::size_t>(step)]);
  }
};

/// An array of an HDF5 file, with how it is stored.
struct HdfLayout
{
  FileArray Array;
  ChunkStorage Values;
  HdfDataset Origin;
  std::vector<CodecStep> Steps; ///< that made the bytes of its chunks

  /// Data that the datasets of a file have in common.
  struct Place
  {
    const std::string& Path;
    hid_t File;
    hid_t Root; ///< of the level of detail
    const PositionedFile& Bytes;
    bool Grows; ///< another program appends to it
    const std::function<bool()>& GoesOn;
    HdfOrigins& Origins;                ///< those of the dataset are added
    std::vector<std::string>& Warnings; ///< of attributes that are not honored
  };

  /// `member`: see HdfValues. Returns nothing where the dataset has no numbers, or a filter is
  /// missing that its first sample needs; then a sentence in the warnings says so. Throws
  /// dsm::Error, which names the file. The caller has GetHdfLock.
  static std::optional<HdfLayout> Find(const Place& place, HdfHandle dataset,
    const std::string& name, const std::string& member, bool onCells, const HdfAxes& axes);

  /// Returns whether equal numbers in both mean equal values.
  bool HasSameValues(const HdfLayout& other) const;
  /// Returns whether chunks of both, which have one shape and HasSameValues, are found and unpacked in one way.
  bool IsStoredLike(const HdfLayout& other) const;
  /// From now on the library reads the values, in boxes of any array.
  void LeaveToLibrary();
};

} // namespace vol

#endif
