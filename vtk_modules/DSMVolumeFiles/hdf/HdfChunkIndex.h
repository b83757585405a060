// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfChunkIndex_h
#define vol_HdfChunkIndex_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMVolumeFiles/base/PositionedFile.h"
#include "DSMVolumeFiles/hdf/HdfChunkLayout.h"

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

  // Functions that readers of all kinds share: blocks of the file, entries for chunks, the order of numbered chunks.
  std::size_t GetAxes() const { return this->Most.size(); }

  /// As HdfBytes has them; nothing where more is read altogether than the file has.
  std::optional<HdfBytes> Read(std::uint64_t offset, std::uint64_t count);
  std::optional<HdfBytes> ReadChecked(
    std::uint64_t offset, std::uint64_t count, const char* signature);

  /// Visits the chunk at a place. False: the visitor, or damage, ends it.
  bool Add(const std::uint64_t* place, const HdfChunk& chunk);
  /// The chunk of a number, where all are numbered along the axes, of which the last one is the fastest, or where one
  /// axis grows without a limit, that one as the slowest. False likewise.
  bool AddNumbered(std::uint64_t number, const HdfChunk& chunk);

  /// Chunks that the dataset may grow to; nothing where there is no limit, or they cannot be counted.
  std::optional<std::uint64_t> CountMost() const;

  /// An entry of arrays and trees: an address, and, of filtered chunks, how many bytes and which filters are left out.
  /// `entryBytes` is 8 for chunks that are not filtered.
  static bool IsEntry(bool isFiltered, std::uint64_t entryBytes);
  HdfChunk GetChunk(const HdfBytes& block, std::size_t place, std::size_t entryBytes) const;
  /// Adds `count` entries of numbered chunks, from `number` on.
  bool AddEntries(const HdfBytes& block, std::size_t place, std::size_t entryBytes,
    std::uint64_t number, std::uint64_t count);
  /// Likewise, in pages of so many entries from an address on, each with a checksum. `isThere(page)`: whether it was
  /// written.
  bool AddPages(std::uint64_t address, std::uint64_t pageEntries, std::size_t entryBytes,
    std::uint64_t number, std::uint64_t count,
    const dsm::FunctionRef<bool(std::uint64_t page)>& isThere);

private:
  HdfChunkIndex(const PositionedFile& file, const HdfChunkLayout& layout,
    const std::vector<std::uint64_t>& most, const Visit& visit);

  // Each reads one kind of index at an address.
  bool ReadTree1(std::uint64_t address);
  bool ReadTree2(std::uint64_t address);
  bool ReadFixedArray(std::uint64_t address);
  bool ReadExtensibleArray(std::uint64_t address);
  bool ReadImplicit(std::uint64_t address);
  bool ReadNode1(std::uint64_t address, int level);
  /// Counts so many bytes as read. Returns false if they exceed what may still be read.
  bool Spend(std::uint64_t count);

  const PositionedFile& File;
  const Visit& Tell;
  std::vector<std::uint64_t> Edges;
  std::vector<std::uint64_t> Most;  ///< chunks along each axis; UINT64_MAX: any number
  std::vector<std::size_t> Order;   ///< axes of numbered chunks, the slowest first
  std::vector<std::uint64_t> Place; ///< position of the chunk that is visited
  std::uint64_t Left;               ///< bytes that may still be read
  std::uint32_t PlainBytes = 0;
};

} // namespace vol

#endif
