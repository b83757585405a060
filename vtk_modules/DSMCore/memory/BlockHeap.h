// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockHeap_h
#define dsm_BlockHeap_h

#include "DSMCore/base/Block.h"
#include "DSMCore/memory/BlockArena.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace dsm
{

/// Memory for blocks that come and go one by one: cut from a few large arenas, so that a block costs no call
/// of the system, and lies in large pages where there are any. Neighbors that are free become one
/// extent again, so blocks of all sizes share the memory. An arena without a block goes back to the system.
///
/// Any thread.
class BlockHeap
{
public:
  /// The heap that all stores of the process share.
  static BlockHeap& GetShared();

  BlockHeap() = default;
  BlockHeap(const BlockHeap&) = delete;
  BlockHeap& operator=(const BlockHeap&) = delete;

  /// Memory for `bytes` of a block, aligned to BlockAlignment, not set. Throws std::bad_alloc.
  std::byte* Allocate(std::size_t bytes);
  /// `bytes`: as it was allocated.
  void Free(std::byte* memory, std::size_t bytes) noexcept;
  /// Gives the pages of all that is free back to the system.
  void ReturnFreePages() noexcept;

  /// Returns the bytes of the allocated blocks; GetArenaBytes those of the arenas that hold them.
  std::size_t GetBlockBytes() const;
  std::size_t GetArenaBytes() const;

private:
  /// A part of an arena that is free. It stands at the beginning of that part, and its size at the end, too.
  struct Extent
  {
    std::size_t Bytes;
    Extent* Next; ///< in its list
    Extent* Previous;
  };
  struct Arena
  {
    BlockArena Memory;
    /// A bit for each unit of BlockAlignment: whether an extent begins, or ends, there.
    std::vector<std::uint64_t> Begins;
    std::vector<std::uint64_t> Ends;
  };
  /// Extents of 2^n to 2^(n+1) - 1 units are in four lists.
  static constexpr std::size_t Lists = 160;

  static std::size_t GetList(std::size_t bytes);
  /// The first arena that begins behind a place.
  std::vector<Arena>::iterator FindArenaBehind(const std::byte* memory);
  Arena& FindArena(const std::byte* memory) { return *(this->FindArenaBehind(memory) - 1); }
  Extent* FindExtent(std::size_t bytes);
  void AddArena(std::size_t bytes);
  static void FlipEnds(Arena& arena, const std::byte* memory, std::size_t bytes) noexcept;
  void Insert(Arena& arena, std::byte* memory, std::size_t bytes) noexcept;
  void Remove(Arena& arena, Extent* extent) noexcept;

  mutable std::mutex Guard;
  std::vector<Arena> Arenas; ///< by address
  std::array<Extent*, Lists> Extents{};
  std::size_t BlockBytes = 0;
  std::size_t ArenaBytes = 0;
};

} // namespace dsm

#endif
