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
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace dsm
{

/// The way of a miss, the same for every store that fetches blocks: queues, states of lines, room,
/// sources, and the frame around them. A block that is missed first is queued; workers that miss it
/// later join. The communication thread takes the queue in order: it sets memory aside (evicting if it
/// must, and waiting if it cannot), then lets the block's source read it, so what comes always finds
/// room. What workers foresee, or a frame begins by foreseeing since the last ones needed it
/// (ExpectedBlocks), waits in a queue of its own, which is looked at when nothing is wanted.
/// What other ranks ask for and is not in memory is wanted like what a worker waits for.
///
/// A store derives from it, and says where bytes land, and how a block is shown to workers and taken
/// away.
class BlockFetcher
{
public:
  virtual ~BlockFetcher() = default;
  BlockFetcher(const BlockFetcher&) = delete;
  BlockFetcher& operator=(const BlockFetcher&) = delete;

  // -- Between frames, on the communication thread --

  /// Where the ranks agree afterwards: whether a segment may be added. Throws when it may not; else
  /// Add will not fail.
  void PrepareToAdd(std::size_t count = 1);
  void Add(std::shared_ptr<BlockSegment> segment);
  /// Returns what was retired; null when there is no such segment. Throws Error within a frame.
  std::shared_ptr<BlockSegment> Retire(const BlockSegment& segment);
  /// Blocks of which `which` says so have other contents now: what is cached of them goes. Throws within a
  /// frame.
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
  /// What so many bytes of a block take of the cache.
  virtual std::size_t CountFootprint(std::size_t bytes) const = 0;
  /// Null when the block is not in memory. Communication thread, no lock.
  virtual const std::byte* FindOwned(const BlockWant& block) const = 0;
  /// Whether this rank's own source brings a block that is not in memory, not another rank.
  virtual bool IsOwned(const BlockWant& block) const
  {
    return block.From->GetDirectory().GetOwner(block.Id) == this->Messages.GetRank();
  }
  /// That source; null when the block never leaves memory.
  virtual BlockSource* FindSource(const BlockWant& block) const = 0;
  /// Throws Error when a frame cannot begin. No lock.
  virtual void CheckBudget() const = 0;
  /// The source that a worker may read a block from by itself, of whichever rank it is: one for all such blocks of
  /// a segment. Null: the worker has to wait for the communication thread.
  virtual BlockSource* FindSourceForWorkers(const BlockWant&) const { return nullptr; }
  /// Sets room for a block aside; false when that must wait.
  virtual bool MakeRoom(const BlockWant& block) = 0;
  /// The same where nothing has to leave for it.
  virtual bool TakeRoom(const BlockWant&) { return false; }
  /// The block will not come.
  virtual void GiveRoomBack(const BlockWant& block) noexcept = 0;
  /// Brings a block that has come where it belongs, within the room set aside. `memory` has its bytes, or is
  /// null where these are a message's. No lock. When it throws, nothing has changed.
  virtual void Land(const BlockWant& block, const std::byte* bytes, BlockMemory& memory) = 0;
  /// So that the next Show does not fail. May throw std::bad_alloc.
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
  /// Whether a block that was foreseen is under way or here, and nobody has used it.
  virtual bool IsUnused(const BlockWant& block) const = 0;
  /// The frame is over: it becomes an ordinary block. Whether it was here and unused.
  virtual bool Settle(const BlockWant& block) = 0;
  virtual void AddCounters(StoreCounters& counters) const = 0;

  // -- Moments of a frame at which a store may have more to do; under the lock --

  virtual void Opened() {}
  /// The frame is open no more: cancelled, or over. Before, and after the queues were emptied.
  virtual void Closing() {}
  virtual void Closed() {}
  /// Before the queues are looked at. Returns whether it did anything.
  virtual bool BeginService() { return false; }
  /// Whether there is something for it without the queues. No lock.
  virtual bool NeedsService() const { return false; }
  /// Behind BeginService and the queues; no lock.
  virtual void EndService() {}

  // -- For the stores, under the lock --

  /// Queues a block that is absent, or joins those who wait for it. Returns whether it joined, or the system was
  /// advised of the block before.
  bool Want(const BlockWant& block);
  /// A worker misses a block, and reads it by itself, without the lock, where nobody brings it yet, there is
  /// room, and nothing has to be waited for: it spares threads that wake one another. Returns whether the block is
  /// here now; else the worker must have it wanted, if the frame is still open, for others may wait by now.
  bool ReadAtOnce(FetchWorker& worker, const BlockWant& block, std::unique_lock<std::mutex>& lock);
  /// A worker misses a block, and waits until it is here or the frame is open no more. `keeps`: the
  /// block stays until the worker has its slot back.
  void WaitFor(FetchWorker& worker, const BlockWant& block, std::unique_lock<std::mutex>& lock,
    WorkerSlots* slots, bool keeps);
  /// Throws why a block cannot be had now.
  [[noreturn]] void Refuse(const BlockSegment& segment) const;
  std::size_t GetFootprint(const BlockWant& block) const
  {
    return this->CountFootprint(block.From->GetDirectory().GetBytes(block.Id));
  }
  /// Room for this rank's own blocks while others are on their way.
  std::size_t GetRoomForOwn() const;
  /// Throws Error when a cache of so many bytes cannot hold the largest block that comes and goes, of so many bytes,
  /// and one of the rank's own.
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
  /// What reads from other ranks may take of the cache. Where ranks have blocks in memory for a time
  /// only, a rank must always find room for its own: two that wait for one another's would wait for
  /// ever if all their room were set aside for what they wait for.
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
  /// Of those that are absent: the system is to be advised of blocks that workers can read by themselves then, which go
  /// to `advised`; the others are queued, as far as there may be so many. Returns whether any was queued.
  bool QueuePrefetches(const BlockSegment& segment, const BlockId* ids, std::size_t count,
    std::vector<BlockId>& advised);
  bool TryAdvise(const BlockWant& block, std::vector<BlockId>& advised);
  /// With or without the lock.
  void Advise(const BlockSegment& segment, std::vector<BlockId> ids) const;

  /// Of other ranks, and own ones, which come first: others may wait for them.
  std::deque<BlockWant> Wanted;
  std::deque<BlockWant> WantedOwn;
  /// Room set aside for reads from other ranks.
  std::size_t BytesOfOthers = 0;
  ExpectedBlocks Expected;
  /// Some may have become wanted, or come, since they were queued.
  std::deque<BlockWant> PrefetchQueue;
  /// Of these queues; lets Service look without the lock.
  std::atomic<std::size_t> QueuedCount{ 0 };
  /// Foreseen, and not queued: the system was advised of them.
  std::vector<BlockWant> Advised;
  /// Of them, in this frame: wanted later. Each counts as prefetched, and whoever wants it as joining.
  std::uint64_t AdvisedUsed = 0;
  /// Workers may have read blocks that other ranks asked for.
  std::atomic<bool> MayHaveDebtsHere{ false };
  /// Other than Requests; those with reads under way. Communication thread only.
  std::vector<BlockSource*> Busy;
};

} // namespace dsm

#endif
