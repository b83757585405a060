// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PrefetchLedger_h
#define dsm_PrefetchLedger_h

#include "DSMCore/fetch/BlockSource.h"

#include <cstddef>
#include <cstdint>
#include <deque>

namespace dsm
{

/// Prefetched blocks that no worker has used yet. Their share of the cache is limited, so that wrong
/// predictions cannot displace blocks in use. Only a block's line knows whether the block is still unused,
/// and workers mark it without a lock; so the ledger checks its blocks in turn, a few with every block that
/// is added. It also counts how many were used. Under the store's lock.
class PrefetchLedger
{
public:
  /// With a cache of so many bytes.
  void BeginFrame(std::size_t cacheBytes)
  {
    this->Limit = cacheBytes / CacheDivisor;
    this->Arrived = 0;
    this->Lost = 0;
    this->Joined = 0;
  }

  /// Adds a block that takes `footprint` bytes; returns false when the limit is reached. `isUnused(block)`:
  /// whether it is pending or cached, and no worker has used it.
  template <class IsUnused>
  bool TryAdd(const BlockWant& block, std::size_t footprint, const IsUnused& isUnused)
  {
    for (int step = 0; step < Steps && !this->Entries.empty(); ++step)
    {
      const Entry entry = this->Entries.front();
      this->Entries.pop_front();
      if (isUnused(entry.Block))
      {
        this->Entries.push_back(entry);
      }
      else
      {
        this->Bytes -= entry.Footprint;
      }
    }
    if (this->Bytes + footprint > this->Limit)
    {
      return false;
    }
    this->Entries.push_back({ block, footprint });
    this->Bytes += footprint;
    return true;
  }

  /// A worker waits for one that is under way.
  void CountJoin() { ++this->Joined; }
  /// Counts a block that has arrived and that no worker waits for.
  void CountArrival() { ++this->Arrived; }
  /// Counts evicted blocks that no worker has used.
  void CountLosses(std::size_t count) { this->Lost += count; }

  /// Forgets all blocks; returns how many have been used in the frame. `settle(block)` is called for each
  /// block, some of them twice, makes it an ordinary one, and returns whether it was here and unused.
  template <class SettleBlock>
  std::uint64_t EndFrame(const SettleBlock& settle)
  {
    for (const Entry& entry : this->Entries)
    {
      this->Lost += settle(entry.Block) ? 1 : 0;
    }
    this->Entries.clear();
    this->Bytes = 0;
    return this->Joined + this->Arrived - this->Lost;
  }

private:
  struct Entry
  {
    BlockWant Block;
    std::size_t Footprint;
  };

  /// Divisor of the cache's size for the share of unused blocks.
  static constexpr std::size_t CacheDivisor = 4;
  /// Blocks that are looked at for each one that is added: two, so that room is found again.
  static constexpr int Steps = 2;

  std::deque<Entry> Entries;
  std::size_t Bytes = 0; ///< footprints of all entries
  std::size_t Limit = 0;
  std::uint64_t Arrived = 0;
  std::uint64_t Lost = 0;
  std::uint64_t Joined = 0;
};

} // namespace dsm

#endif
