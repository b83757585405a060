// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PageCache_h
#define dsm_PageCache_h

#include "DSMCore/base/Block.h"
#include "DSMCore/paged/PagedStore.h"

#include <chrono>
#include <cstddef>
#include <functional>
#include <vector>

namespace dsm
{

/// Records which remote blocks have pages, within a budget that is never exceeded: room is set aside before a block
/// is requested. Replacement is CLOCK, its reference bits being the blocks' hints; in a store of pure faults the
/// use of blocks is unknown, and it is first in, first out. Blocks that were prefetched and not used yet are passed
/// by once. It keeps the accounts only: the pages themselves are the store's to move.
///
/// Communication thread only, under the store's lock.
class PageCache
{
public:
  using Time = std::chrono::steady_clock::time_point;

  struct Slot
  {
    const PagedStore::Segment* From = nullptr; ///< null: the slot is empty
    BlockId Id = 0;
    std::size_t Footprint = 0;
    Time Placed;
    bool IsSpared = false;  ///< the hand has passed it once, prefetched and unused
    bool WasUnused = false; ///< for an evicted block: prefetched, and never used
  };

  void SetCapacity(std::size_t bytes) { this->Capacity = bytes; }
  std::size_t GetCapacity() const { return this->Capacity; }
  /// Cached and set aside.
  std::size_t GetUsed() const { return this->Used; }
  /// The most that was used since ResetPeak.
  std::size_t GetPeak() const { return this->Peak; }
  void ResetPeak() { this->Peak = this->Used; }

  /// Sets room aside for a block; false when there is none now.
  bool TryReserve(std::size_t footprint);
  /// The room of a block that will not come.
  void Release(std::size_t footprint) { this->Used -= footprint; }
  /// Allocates a slot for a pending block, so that Insert will not fail. Throws std::bad_alloc.
  void PrepareSlot();
  /// Puts a block into the room that was set aside for it.
  void Insert(const Slot& slot);

  /// Takes out a block that no worker waits for, and that was placed at `before` or earlier; returns false if
  /// there is none.
  bool TryEvict(Time before, Slot& evicted);
  std::vector<BlockId> List(const PagedStore::Segment& segment) const;
  /// Takes out all blocks of a segment; `visit` is called for each. `which` (null: all): only blocks for
  /// which it is true.
  void Forget(const PagedStore::Segment& segment, const std::function<void(const Slot&)>& visit,
    const std::vector<bool>* which = nullptr);

private:
  Slot TakeOut(std::size_t index);

  std::vector<Slot> Slots; ///< the clock's face
  std::vector<std::size_t> EmptySlots;
  std::size_t Hand = 0;
  std::size_t Used = 0;
  std::size_t Peak = 0;
  std::size_t Capacity = 0;
};

} // namespace dsm

#endif
