// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ObjectStoreInternals_h
#define dsm_ObjectStoreInternals_h

#include "DSMCore/fetch/BlockFetcher.h"
#include "DSMCore/table/BlockCache.h"
#include "DSMCore/table/ObjectStore.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace dsm
{

/// The store's slow paths: a block lands in memory of its own, is shown by its address in the table,
/// and is evicted by taking that away and waiting for the workers to pass a quiescent point.
class ObjectStore::Internals final : public BlockFetcher
{
public:
  Internals(ObjectStore& store, Messenger& messenger, const Settings& settings);
  ~Internals() override;

  const std::byte* Wait(Worker& worker, const Segment& segment, BlockId id);
  std::array<const std::byte*, 2> WaitForPair(
    Worker& worker, const BlockWant& one, const BlockWant& other);
  bool MayPrefetch() const override;
  void Enter(Worker& worker);
  void Leave(Worker& worker);

  void Configure(const Settings& settings);

  Settings Current;

private:
  static const Segment& GetSegment(const BlockWant& block)
  {
    return *static_cast<const Segment*>(block.From);
  }
  static BlockLine& GetBlockLine(const BlockWant& block)
  {
    return GetSegment(block).Lines[block.Id];
  }

  LineStatus& GetLine(const BlockWant& block) const override { return GetBlockLine(block); }
  std::size_t CountFootprint(std::size_t bytes) const override { return GetBlockFootprint(bytes); }
  const std::byte* FindOwned(const BlockWant& block) const override;
  bool IsOwned(const BlockWant& block) const override;
  BlockSource* FindSource(const BlockWant& block) const override;
  BlockSource* FindSourceForWorkers(const BlockWant& block) const override;
  void CheckBudget() const override
  {
    this->CheckCache(this->Current.CacheBytes, this->GetLargestBlock());
  }
  bool MakeRoom(const BlockWant& block) override;
  bool TakeRoom(const BlockWant& block) override;
  void GiveRoomBack(const BlockWant& block) noexcept override;
  void Land(const BlockWant& block, const std::byte* bytes, BlockMemory& memory) override;
  void PrepareToShow() override { this->Cache.PrepareSlot(); }
  void Show(const BlockWant& block, BlockMemory& memory) override;
  std::vector<BlockId> ListCached(const BlockSegment& segment) const override;
  void Forget(const BlockSegment& segment) override;
  void Forget(const BlockSegment& segment, const std::vector<bool>& which) override;
  bool IsUnused(const BlockWant& block) const override;
  bool Settle(const BlockWant& block) override;
  void AddCounters(StoreCounters& counters) const override;
  void Opened() override;
  void Closed() override;
  bool BeginService() override;
  bool NeedsService() const override { return this->Cache.HasLimbo(); }

  static void CheckMiss(const Worker& worker);
  /// Throws if the blocks of a segment are not available now.
  void CheckOpen(Worker& worker, const BlockWant& block);
  /// Waits for both within the permits for pairs.
  void WaitInTurn(Worker& worker, const BlockWant& one, const BlockWant& other,
    std::unique_lock<std::mutex>& lock);
  std::uint64_t GetOldestEpoch() const;
  std::size_t GetLargestBlock() const;

  ObjectStore& Store;
  BlockCache Cache; ///< under the lock
  std::size_t SpareBytes = 0;
  std::size_t PairsWaiting = 0; ///< workers that wait for pairs, and keep what is here of these
  std::size_t MostPairs = 0;    ///< the most of these
};

} // namespace dsm

#endif
