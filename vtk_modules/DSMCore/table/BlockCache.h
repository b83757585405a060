// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockCache_h
#define dsm_BlockCache_h

#include "DSMCore/base/Block.h"
#include "DSMCore/memory/BlockMemory.h"
#include "DSMCore/table/BlockLine.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace dsm
{

/// The memory for blocks that come and go, within a budget that is never exceeded: room is set aside before a block
/// is requested, and what was evicted counts until it is freed. Replacement is CLOCK, one sweeping hand, an
/// approximation of the paper's least recently used order that needs no list to be kept on a hit. Blocks that were
/// prefetched and not used yet are passed by once.
///
/// Under the store's lock; on the communication thread alone where something leaves: it answers other ranks
/// from the blocks, without the lock. Epochs: see ObjectStore::Worker.
class BlockCache
{
public:
  BlockCache() = default;
  BlockCache(const BlockCache&) = delete;
  BlockCache& operator=(const BlockCache&) = delete;

  struct Evictions
  {
    std::size_t Count = 0;
    std::size_t Unused = 0; ///< evicted blocks that were prefetched and never used
  };

  void SetCapacity(std::size_t bytes) { this->Capacity = bytes; }
  std::size_t GetCapacity() const { return this->Capacity; }
  /// Cached, set aside, and evicted but not yet freed.
  std::size_t GetUsed() const { return this->Used; }
  /// The most that was used since ResetPeak.
  std::size_t GetPeak() const { return this->Peak; }
  void ResetPeak() { this->Peak = this->Used; }

  /// Sets room aside for a block, as much as its footprint (GetBlockFootprint); false when there is none now.
  bool TryReserve(std::size_t blockBytes);
  /// The room of a block that will not come.
  void Release(std::size_t blockBytes);
  /// Allocates a slot for the next block, so that Insert will not fail. Throws std::bad_alloc.
  void PrepareSlot();
  /// Takes over the memory, for which room was reserved, and publishes its address. A prefetched block that
  /// no worker waits for stays marked as such.
  void Insert(BlockLine& line, BlockMemory memory);

  /// Evicts until a block of this size, and `spareBytes` on top, will fit once memory in limbo is
  /// freed; or until nothing can be evicted. A worker whose epoch is at least `epoch` no longer
  /// sees what is evicted now.
  Evictions Evict(std::size_t blockBytes, std::size_t spareBytes, std::uint64_t epoch);
  /// Frees what was evicted at `oldestEpoch` or before. Returns whether it freed anything.
  bool Reclaim(std::uint64_t oldestEpoch);
  bool HasLimbo() const { return !this->Limbo.empty(); }

  /// Returns the cached blocks among `count` lines from `first` on, as offsets from `first`.
  std::vector<BlockId> List(const BlockLine* first, std::size_t count) const;
  /// Between frames: drops the cached blocks among `count` lines from `first` on; `which` (null: all): only
  /// blocks for which it is true, by offset from `first`.
  void Forget(const BlockLine* first, std::size_t count, const std::vector<bool>* which = nullptr);
  /// Between frames: evicts and frees until the budget is met.
  void Shrink();

private:
  struct Slot
  {
    BlockLine* Line = nullptr; ///< null: the slot is empty
    BlockMemory Memory;
    std::size_t Footprint = 0;
    bool IsSpared = false; ///< the hand has passed it once, prefetched and unused
  };
  struct Evicted
  {
    BlockMemory Memory;
    std::size_t Footprint = 0;
    std::uint64_t Epoch = 0;
  };

  /// Between frames: as EvictSlot, but no worker can be reading the block.
  void Drop(std::size_t slot);
  void EvictSlot(std::size_t slot, std::uint64_t epoch);

  std::vector<Slot> Slots; ///< the clock's face
  std::vector<std::size_t> EmptySlots;
  std::size_t Hand = 0;
  std::deque<Evicted> Limbo; ///< ascending epochs
  std::size_t LimboBytes = 0;
  std::size_t Used = 0;
  std::size_t Peak = 0;
  std::size_t Capacity = 0;
};

} // namespace dsm

#endif
