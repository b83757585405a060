// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PrefetchLedger_h
#define dsm_PrefetchLedger_h

#include "DSMCore/fetch/BlockSource.h"

#include <cstddef>
#include <cstdint>
#include <deque>

namespace dsm
{

/// The blocks that a store fetches before anybody needs them, until somebody does: their share of the
/// cache is limited, so that what was foreseen wrongly cannot displace what is in use. Whether a block
/// is still unused only its line knows, which workers mark without a lock; so the ledger looks at its
/// blocks in turn, a few with every block that is added. It also counts what becomes of them. Under the
/// store's lock.
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

  /// Adds a block that takes `footprint` bytes; false when there are as many as there may be.
  /// `isUnused(block)`: whether it is under way or here, and nobody has used it.
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
  /// One has come that nobody waits for.
  void CountArrival() { ++this->Arrived; }
  /// So many were evicted that nobody has used.
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

  /// The cache is divided by it for blocks that nobody has used.
  static constexpr std::size_t CacheDivisor = 4;
  /// Blocks that are looked at for each one that is added: two, so that room is found again.
  static constexpr int Steps = 2;

  std::deque<Entry> Entries;
  std::size_t Bytes = 0; ///< of the entries
  std::size_t Limit = 0;
  std::uint64_t Arrived = 0;
  std::uint64_t Lost = 0;
  std::uint64_t Joined = 0;
};

} // namespace dsm

#endif
