// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfIndexReader_h
#define vol_HdfIndexReader_h

#include "DSMVolumeFiles/format/HdfChunkIndex.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace vol
{

/// Functions that the readers of all kinds of chunk indices (HdfChunkIndex) share: blocks of the file, entries for
/// chunks, and the order of numbered chunks.
class HdfIndexReader
{
public:
  HdfIndexReader(const PositionedFile& file, const HdfChunkLayout& layout,
    const std::vector<std::uint64_t>& most, const HdfChunkIndex::Visit& visit);

  std::size_t GetAxes() const { return this->Most.size(); }

  /// As HdfBytes has them; nothing where more is read altogether than the file has.
  std::optional<HdfBytes> Read(std::uint64_t offset, std::uint64_t count);
  std::optional<HdfBytes> ReadChecked(
    std::uint64_t offset, std::uint64_t count, const char* signature);
  /// The same for a block that has a checksum, but no signature.
  std::optional<HdfBytes> ReadPage(std::uint64_t offset, std::uint64_t count);

  /// Visits the chunk at a place. False: the visitor, or damage, ends it.
  bool Add(const std::uint64_t* place, const HdfChunk& chunk);
  /// The chunk of a number, where all are numbered along the axes, of which the last one is the fastest, or where one
  /// axis grows without a limit, that one as the slowest. False likewise.
  bool AddNumbered(std::uint64_t number, const HdfChunk& chunk);

  /// Bytes of a chunk without filters; 0: too many.
  std::uint32_t GetPlainBytes() const { return this->PlainBytes; }
  /// Chunks that the dataset may grow to; nothing where there is no limit, or they cannot be counted.
  std::optional<std::uint64_t> CountMost() const;

  /// An entry of arrays and trees: an address, and, of filtered chunks, how many bytes and which filters are left out.
  /// `entryBytes` is 8 for chunks that are not filtered.
  static bool IsEntry(bool isFiltered, std::uint64_t entryBytes);
  HdfChunk GetChunk(const HdfBytes& block, std::size_t place, std::size_t entryBytes) const;
  /// Adds `count` entries of numbered chunks, from `number` on.
  bool AddEntries(const HdfBytes& block, std::size_t place, std::size_t entryBytes,
    std::uint64_t number, std::uint64_t count);

  // Each reads one kind of index at an address.
  bool ReadTree1(std::uint64_t address);
  bool ReadTree2(std::uint64_t address);
  bool ReadFixedArray(std::uint64_t address);
  bool ReadExtensibleArray(std::uint64_t address);
  bool ReadImplicit(std::uint64_t address);

private:
  const PositionedFile& File;
  const HdfChunkIndex::Visit& Tell;
  std::vector<std::uint64_t> Edges;
  std::vector<std::uint64_t> Most;  ///< chunks along each axis; UINT64_MAX: any number
  std::vector<std::size_t> Order;   ///< axes of numbered chunks, the slowest first
  std::vector<std::uint64_t> Place; ///< position of the chunk that is visited
  std::uint64_t Left;               ///< bytes that may still be read
  std::uint32_t PlainBytes = 0;

  /// Counts so many bytes as read. Returns false if they exceed what may still be read.
  bool Spend(std::uint64_t count);
  bool ReadNode1(std::uint64_t address, int level);
};

} // namespace vol

#endif
