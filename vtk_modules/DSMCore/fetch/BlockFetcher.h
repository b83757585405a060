// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockFetcher_h
#define dsm_BlockFetcher_h

#include "DSMCore/base/Counters.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/base/WorkerSlots.h"
#include "DSMCore/fetch/BlockRequests.h"
#include "DSMCore/fetch/BlockSource.h"
#include "DSMCore/fetch/ExpectedBlocks.h"
#include "DSMCore/fetch/FetchWorkers.h"
#include "DSMCore/fetch/LineStatus.h"
#include "DSMCore/fetch/PrefetchLedger.h"
#include "DSMCore/publish/SegmentList.h"
#include "DSMCore/transport/Messenger.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace dsm
{

/// Handles cache misses for every store that fetches blocks: queues, line states, room in the
/// cache, sources, and the frame around them. A missed block is queued; workers that miss it later
/// join. The communication thread processes the queue in order: it reserves memory (evicting if
/// necessary, waiting if eviction is impossible) and then lets the block's source read it, so a
/// block that arrives always finds room. Blocks that workers foresee, or that a frame expects
/// because recent frames needed them (ExpectedBlocks), wait in a separate queue, which is served
/// when no block is wanted. A block that another rank requests and that is not in memory is wanted
/// like a block that a worker waits for.
///
/// A store derives from this class. It defines where the bytes are stored, and how a block is
/// published to workers and withdrawn.
class BlockFetcher
{
public:
  virtual ~BlockFetcher() = default;
  BlockFetcher(const BlockFetcher&) = delete;
  BlockFetcher& operator=(const BlockFetcher&) = delete;

  // -- Between frames, on the communication thread --

  /// Checks whether `count` segments may be added. Throws when they may not; otherwise Add will not fail. The
  /// caller has to let the ranks agree afterwards.
  void PrepareToAdd(std::size_t count = 1);
  void Add(std::shared_ptr<BlockSegment> segment);
  /// Returns what was retired; null when there is no such segment. Throws Error within a frame.
  std::shared_ptr<BlockSegment> Retire(const BlockSegment& segment);
  /// The contents of the blocks for which `which` is true have changed: drops their cached copies. Throws
  /// within a frame.
  void Refresh(const BlockSegment& segment, const std::vector<bool>& which);

  // -- The frame, on the communication thread; see ObjectStore --

  virtual bool MayPrefetch() const = 0;
  bool MayBeginFrame() const;
  void BeginFrame(bool agreed);
  bool Service();
  void Cancel(std::string cause);
  bool Drain();
  void EndFrame();
  bool IsInFrame() const { return this->Phase != FramePhase::Closed; }

  std::uint64_t GetMisses(const FetchWorker& worker) const;
  StoreCounters GetCounters();
  std::uint64_t GetBytesFrom(int owner) const { return this->Requests.GetBytesFrom(owner); }
  std::vector<WorkerCounters> GetWorkerCounters();

  // -- Workers --

  /// See ObjectStore.
  void Prefetch(const BlockSegment& segment, const BlockId* ids, std::size_t count,
    FunctionRef<void(BlockId, std::vector<BlockId>&)> addNeighbors);

  Messenger& Messages;
  FetchWorkers Workers;

protected:
  enum class FramePhase
  {
    Closed,
    Open,
    Cancelled
  };

  /// A read under way.
  struct Read
  {
    BlockWant Block;
    BlockSource* From;
  };

  explicit BlockFetcher(Messenger& messenger);

  // -- What a store says; under the lock unless it says otherwise --

  virtual LineStatus& GetLine(const BlockWant& block) const = 0;
  /// Returns the number of bytes of the cache that a block of `bytes` bytes occupies.
  virtual std::size_t CountFootprint(std::size_t bytes) const = 0;
  /// Null when the block is not in memory. Communication thread, no lock.
  virtual const std::byte* FindOwned(const BlockWant& block) const = 0;
  /// Returns whether this rank's own source, rather than another rank, reads a block that is not in
  /// memory.
  virtual bool IsOwned(const BlockWant& block) const
  {
    return block.From->GetDirectory().GetOwner(block.Id) == this->Messages.GetRank();
  }
  /// Returns the source that can bring a block again; null if the block never leaves memory.
  virtual BlockSource* FindSource(const BlockWant& block) const = 0;
  /// Throws Error when a frame cannot begin. No lock.
  virtual void CheckBudget() const = 0;
  /// The source that a worker may read a block from by itself, of whichever rank it is: one for all such blocks of
  /// a segment. Null: the worker has to wait for the communication thread.
  virtual BlockSource* FindSourceForWorkers(const BlockWant&) const { return nullptr; }
  /// Sets room for a block aside; false when that must wait.
  virtual bool MakeRoom(const BlockWant& block) = 0;
  /// The same, but evicts nothing.
  virtual bool TakeRoom(const BlockWant&) { return false; }
  /// The block will not come.
  virtual void GiveRoomBack(const BlockWant& block) noexcept = 0;
  /// Brings a block that has come where it belongs, within the room set aside. `memory` has its bytes, or is
  /// null where these are a message's. No lock. When it throws, nothing has changed.
  virtual void Land(const BlockWant& block, const std::byte* bytes, BlockMemory& memory) = 0;
  /// Allocates what the next Show needs, which cannot fail then. May throw std::bad_alloc.
  virtual void PrepareToShow() {}
  /// Lets workers have the block that has landed, with what Land made of its memory, which may be kept. Does
  /// not fail.
  virtual void Show(const BlockWant& block, BlockMemory& memory) = 0;
  /// Its cached blocks, in any order. May throw std::bad_alloc.
  virtual std::vector<BlockId> ListCached(const BlockSegment& segment) const = 0;
  /// Takes the segment's cached blocks out. Does not fail.
  virtual void Forget(const BlockSegment& segment) = 0;
  /// The same for some of its blocks; may throw.
  virtual void Forget(const BlockSegment& segment, const std::vector<bool>& which) = 0;
  /// Returns whether a foreseen block is pending or cached, and no worker has used it.
  virtual bool IsUnused(const BlockWant& block) const = 0;
  /// Called after a frame: a foreseen block becomes an ordinary one. Returns whether it was here and unused.
  virtual bool Settle(const BlockWant& block) = 0;
  virtual void AddCounters(StoreCounters& counters) const = 0;

  // -- Moments of a frame at which a store may have more to do; under the lock --

  virtual void Opened() {}
  /// Called at the end of a frame, finished or cancelled: before and after the queues are emptied.
  virtual void Closing() {}
  virtual void Closed() {}
  /// Called before the queues are processed. Returns whether it did anything.
  virtual bool BeginService() { return false; }
  /// Returns whether the store has work for the communication thread apart from the queues. No
  /// lock.
  virtual bool NeedsService() const { return false; }
  /// Behind BeginService and the queues; no lock.
  virtual void EndService() {}

  // -- For the stores, under the lock --

  /// Queues a block that is absent, or joins the workers that wait for it. Returns whether it joined, or the system
  /// was advised of the block before.
  bool Want(const BlockWant& block);
  /// Lets a worker that misses a block read it by itself, without the lock. This requires that no other
  /// thread reads it, that there is room, and that the read does not wait; it avoids waking threads. Returns
  /// whether the block is here now. If not, the worker has to call Want, if the frame is still open, because
  /// others may wait by now.
  bool ReadAtOnce(FetchWorker& worker, const BlockWant& block, std::unique_lock<std::mutex>& lock);
  /// A worker misses a block, or one or both of a pair, and waits until all are here or the frame has ended. Those
  /// that are here stay meanwhile. `keeps`: all stay until the worker has its slot back.
  void WaitFor(FetchWorker& worker, std::initializer_list<BlockWant> blocks,
    std::unique_lock<std::mutex>& lock, WorkerSlots* slots, bool keeps);
  /// Throws the reason why a block is not available now.
  [[noreturn]] void Refuse(const BlockSegment& segment) const;
  std::size_t GetFootprint(const BlockWant& block) const
  {
    return this->CountFootprint(block.From->GetDirectory().GetBytes(block.Id));
  }
  /// Room for this rank's own blocks while others are on their way.
  std::size_t GetRoomForOwn() const;
  /// Returns whether workers read blocks of any segment in pairs.
  bool IsAnyPaired() const;
  /// Throws Error when a cache of so many bytes cannot hold the largest block that comes and goes, of so many
  /// bytes, or a pair of such, and one of the rank's own.
  void CheckCache(std::size_t cacheBytes, std::size_t largest) const;
  bool IsOpenFor(const BlockSegment& segment) const
  {
    return this->Phase == FramePhase::Open && this->Segments.Has(segment);
  }
  void CountEvictions(std::size_t count, std::size_t unused);

  /// Guards what follows but Reads and Requests, the lines, and what workers have for the slow path.
  mutable std::mutex Guard;
  /// Changed by the communication thread alone, which needs no lock to read it.
  SegmentList<BlockSegment> Segments;
  FramePhase Phase = FramePhase::Closed;
  std::string Cause;
  StoreCounters FrameCounters;
  PrefetchLedger Prefetches;
  std::vector<Read> Reads; ///< communication thread only
  /// Upper bound, in bytes of the cache, for reads from other ranks. Where blocks stay in memory
  /// only for a time, a rank must always find room for its own blocks: two ranks that wait for each
  /// other's blocks would deadlock if all their room were reserved for these.
  std::size_t RoomForOthers = std::numeric_limits<std::size_t>::max();
  BlockRequests Requests;

private:
  BlockRequests::Callbacks MakeCallbacks();
  /// Its bytes are copied where `memory` does not have them.
  void Arrive(const BlockWant& block, const std::byte* bytes, BlockMemory memory);
  /// Begin reads for those that room can be made for; whether for all.
  bool AskForWanted(std::deque<BlockWant>& wanted);
  void AskForPrefetches();
  /// Begins a read; false when it must wait for room.
  bool TryAsk(const BlockWant& block);
  bool PollSources();
  bool SubmitReads();
  void AbandonAll();
  void AbandonPrefetches();
  void SettlePrefetches();
  void UpdateQueuedCount();
  /// Handles the absent blocks among `ids`. Blocks that workers can read by themselves are appended
  /// to `advised`, so that the system is advised of them later. The others are queued, up to the
  /// limit for prefetches. Returns whether any block was queued.
  bool QueuePrefetches(const BlockSegment& segment, const BlockId* ids, std::size_t count,
    std::vector<BlockId>& advised);
  bool TryAdvise(const BlockWant& block, std::vector<BlockId>& advised);
  /// With or without the lock.
  void Advise(const BlockSegment& segment, std::vector<BlockId> ids) const;

  /// Wanted blocks of other ranks, and of this rank (WantedOwn). The latter are served first: other
  /// ranks may wait for them.
  std::deque<BlockWant> Wanted;
  std::deque<BlockWant> WantedOwn;
  /// Room set aside for reads from other ranks.
  std::size_t BytesOfOthers = 0;
  ExpectedBlocks Expected;
  /// Some may have become wanted, or come, since they were queued.
  std::deque<BlockWant> PrefetchQueue;
  /// Number of blocks in these queues; lets Service check without the lock.
  std::atomic<std::size_t> QueuedCount{ 0 };
  /// Foreseen, and not queued: the system was advised of them.
  std::vector<BlockWant> Advised;
  /// Number of advised blocks that were wanted later in this frame. Each counts as prefetched, and each
  /// worker that wants it as joining.
  std::uint64_t AdvisedUsed = 0;
  /// Workers may have read blocks that other ranks asked for.
  std::atomic<bool> MayHaveDebtsHere{ false };
  /// Other than Requests; those with reads under way. Communication thread only.
  std::vector<BlockSource*> Busy;
};

} // namespace dsm

#endif
