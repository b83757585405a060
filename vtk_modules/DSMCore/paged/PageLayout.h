// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PageLayout_h
#define dsm_PageLayout_h

#include "DSMCore/base/Block.h"
#include "DSMCore/publish/BlockDirectory.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dsm
{

/// Offset of each block of a segment in the segment's address range. Every offset is a multiple of
/// the page size; there are no gaps. The blocks of one owner are contiguous, in ascending order of
/// id: a rank's own blocks are one run of memory (large pages, few mappings), and the other ranks'
/// blocks are two.
class PageLayout
{
public:
  PageLayout() = default;
  /// Owners are in [0, owners). The directory must outlive the layout. Throws Error when the range
  /// exceeds 64 bits.
  PageLayout(const BlockDirectory& directory, int owners, std::size_t pageBytes);

  /// Memory of the layout itself, in bytes per block.
  static constexpr std::size_t BytesPerBlock = sizeof(std::uint64_t) + sizeof(BlockId);

  std::uint64_t GetOffset(BlockId id) const { return this->Offsets[id]; }

  /// Whole pages, 0 for a block of no bytes.
  std::uint64_t GetFootprint(BlockId id) const
  {
    return (this->Directory->GetBytes(id) + this->PageBytes - 1) / this->PageBytes *
      this->PageBytes;
  }

  /// Returns the size of the whole range in bytes.
  std::uint64_t GetBytes() const { return this->ShareBegins.back(); }
  /// Offsets at which an owner's blocks begin and end.
  std::uint64_t GetShareBegin(int owner) const { return this->ShareBegins[owner]; }
  std::uint64_t GetShareEnd(int owner) const { return this->ShareBegins[owner + 1]; }

  /// The block that has the byte at `offset` in one of its pages; false beyond the last.
  bool Find(std::uint64_t offset, BlockId& id) const;

private:
  const BlockDirectory* Directory = nullptr;
  std::uint64_t PageBytes = 1;
  std::vector<std::uint64_t> ShareBegins; ///< one more than owners
  std::vector<std::uint64_t> Offsets;
  std::vector<BlockId> Order; ///< by offset, without empty blocks
};

} // namespace dsm

#endif
