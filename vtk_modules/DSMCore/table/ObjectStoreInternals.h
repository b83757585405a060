// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ObjectStoreInternals_h
#define dsm_ObjectStoreInternals_h

#include "DSMCore/fetch/BlockRequests.h"
#include "DSMCore/fetch/PrefetchLedger.h"
#include "DSMCore/fetch/StoreWorkers.h"
#include "DSMCore/publish/SegmentList.h"
#include "DSMCore/table/BlockCache.h"
#include "DSMCore/table/ObjectStore.h"

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace dsm
{

/// The store's slow paths: misses, requests, replies, eviction. A block that is missed first is
/// queued; workers that miss it later join. The communication thread takes the queue in order: it
/// sets memory aside (evicting if it must, and waiting for the workers to pass a quiescent point),
/// then sends the request, so a reply always finds room. What workers foresee waits in a queue of its
/// own, which is looked at when nothing is wanted.
class ObjectStore::Internals
{
public:
  Internals(ObjectStore& store, Messenger& messenger, const Settings& settings);

  const std::byte* Wait(Worker& worker, const Segment& segment, BlockId id);
  void Prefetch(const Segment& segment, const BlockId* ids, std::size_t count);
  bool MayPrefetch() const;
  void Enter(Worker& worker);
  void Leave(Worker& worker);

  void Configure(const Settings& settings);
  /// Where the ranks agree afterwards: whether a segment may be added. Throws when it may not; else
  /// Add will not fail.
  void PrepareToAdd();
  void Add(std::shared_ptr<Segment> segment);
  void Retire(const BlockSegment& segment);

  bool MayBeginFrame() const;
  void BeginFrame(bool agreed);
  bool Service();
  void Cancel(const std::string& cause);
  bool Drain();
  void EndFrame();
  bool IsInFrame() const { return this->Phase != FramePhase::Closed; }

  std::uint64_t GetMisses(const Worker& worker) const;
  StoreCounters GetCounters();
  std::vector<WorkerCounters> GetWorkerCounters();

  Messenger& Messages;
  /// Communication thread only.
  SegmentList<Segment> Segments;
  Settings Current;
  StoreWorkers<Worker> Workers;

private:
  enum class FramePhase
  {
    Closed,
    Open,
    Cancelled
  };

  static BlockLine& GetLine(const BlockWant& block)
  {
    return static_cast<const Segment*>(block.From)->Lines[block.Id];
  }

  void CheckBudget() const;
  BlockRequests::Callbacks MakeCallbacks();
  void Take(const BlockWant& block, const std::byte* bytes);
  /// Makes room for the next wanted block; false when it must wait for workers.
  bool MakeRoom(std::size_t blockBytes);
  void AbandonWanted();
  void AbandonForeseen();
  /// Moves those that room can be made for to Requests.
  void AskForWanted();
  void AskForForeseen();
  /// For a block that room was made for; gives the room back when it throws.
  void Ask(const BlockWant& want);
  void UpdateQueuedCount();
  std::uint64_t GetOldestEpoch() const;
  std::size_t GetLargestBlock() const;

  ObjectStore& Store;
  BlockRequests Requests;

  /// Guards what follows, the lines' slow parts, and Worker::Slow and WaitsFor.
  mutable std::mutex Guard;
  FramePhase Phase = FramePhase::Closed;
  std::string Cause;
  BlockCache Cache;
  std::size_t SpareBytes = 0;
  std::deque<BlockWant> Wanted;
  /// Some may have become wanted, or come, since they were queued.
  std::deque<BlockWant> Foreseen;
  PrefetchLedger Prefetches;
  /// Of Wanted and Foreseen; lets Service look without the lock.
  std::atomic<std::size_t> QueuedCount{ 0 };
  StoreCounters Frame;
};

} // namespace dsm

#endif
