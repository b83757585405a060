// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PagedStoreInternals_h
#define dsm_PagedStoreInternals_h

#include "DSMCore/fetch/BlockRequests.h"
#include "DSMCore/fetch/PrefetchLedger.h"
#include "DSMCore/fetch/StoreWorkers.h"
#include "DSMCore/paged/PageCache.h"
#include "DSMCore/paged/PageFaults.h"
#include "DSMCore/paged/PagedStore.h"
#include "DSMCore/publish/SegmentList.h"

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace dsm
{

/// The store's slow paths: misses, faults, requests, replies, eviction. A block that is missed first
/// is queued; threads that miss it later join, whether they wait politely or in a fault. The
/// communication thread takes the queue in order: it makes room, then sends the request, so a reply
/// always finds room. What workers foresee waits in a queue of its own, which is looked at when nothing
/// is wanted.
///
/// A listening thread takes the faults: it queues them, answers those that are none of ours, and
/// after a cancellation satisfies them with zeros, so that no thread waits for a communication
/// thread that has left the frame.
class PagedStore::Internals
{
public:
  Internals(Messenger& messenger, const Settings& settings);
  ~Internals();

  void Wait(Worker& worker, const Segment& segment, BlockId id);
  void Prefetch(const Segment& segment, const BlockId* ids, std::size_t count);
  bool MayPrefetch() const;
  void Enter(Worker& worker);
  void Leave(Worker& worker);

  void Configure(const Settings& settings);
  /// Throws Error when faults cannot be handled as they should, or this process is a fork of the
  /// store's.
  void CheckFaults() const;
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
  /// Any thread: whether a frame runs that was not cancelled.
  bool IsOpen() const { return this->IsEntranceOpen.load(std::memory_order_acquire); }

  std::uint64_t GetMisses(const Worker& worker) const;
  StoreCounters GetCounters();
  std::vector<WorkerCounters> GetWorkerCounters();

  Messenger& Messages;
  Settings Current;
  StoreWorkers<Worker> Workers;
  /// Null with one rank, and when it cannot be had.
  std::shared_ptr<PageFaults> Faults;
  std::string FaultsRefusal;

private:
  using Clock = std::chrono::steady_clock;

  enum class FramePhase
  {
    Closed,
    Open,
    Cancelled
  };

  static const Segment& GetSegment(const BlockWant& block)
  {
    return *static_cast<const Segment*>(block.From);
  }
  static PageLine& GetLine(const BlockWant& block) { return GetSegment(block).Lines[block.Id]; }
  static std::size_t GetFootprint(const BlockWant& block)
  {
    return GetSegment(block).Layout.GetFootprint(block.Id);
  }

  /// A thread that waits in a fault.
  struct Stopped
  {
    PageFaults::Fault Fault;
    const Segment* From;
    BlockId Id;
    Worker* Who; ///< null: a thread that did not enter
    Clock::time_point Since;
  };

  // -- Faults, on the listening thread --
  void StartListening();
  void StopListening();
  /// `faults`: with room for any report, since memory may be short where it is filled.
  void Listen(std::vector<PageFaults::Fault> faults);
  /// Under the lock. Returns whether the communication thread has something to do. Throws
  /// std::bad_alloc in an open frame only; the fault is to be taken again when that is cancelled.
  bool Take(const PageFaults::Fault& fault);
  void TakeCancelled(const PageFaults::Fault& fault, const Segment& segment, BlockId id);
  void AdjustHold(Worker& worker, const PageFaults::Fault& fault);
  Worker* FindWorker(int thread) const;

  // -- The communication thread --
  void CheckBudget() const;
  BlockRequests::Callbacks MakeCallbacks();
  void Take(const BlockWant& block, const std::byte* bytes);
  /// Makes room for a block, evicting into `evicted`; false when it must wait.
  bool MakeRoom(const BlockWant& want, std::vector<PageCache::Frame>& evicted);
  bool TryEvict(bool atEndOfRun, std::vector<PageCache::Frame>& evicted);
  void Remove(const std::vector<PageCache::Frame>& evicted);

  // -- Under the lock --
  /// Queues a block that is absent; or joins those who wait for it. Returns whether it joined.
  bool Request(const Segment& segment, BlockId id);
  /// Cached blocks right before and behind a block's pages.
  std::size_t CountNeighbours(const Segment& segment, BlockId id) const;
  void MarkCached(const Segment& segment, BlockId id);
  void MarkEvicted(const PageCache::Frame& frame);
  /// Moves those that room can be made for to Requests.
  void AskForWanted(std::vector<PageCache::Frame>& evicted);
  void AskForForeseen(std::vector<PageCache::Frame>& evicted);
  /// For a block that room was made for; gives the room back when it throws.
  void Ask(const BlockWant& want);
  void UpdateQueuedCount();
  /// What is wanted or foreseen, and what was asked for, will not come.
  void AbandonRequests();
  void AbandonForeseen();
  void CloseEntrance();
  void RemoveZeros();
  [[noreturn]] void Refuse(const Segment& segment) const;
  std::size_t GetLargestBlock() const;

  pid_t Process;
  std::thread Listener;
  BlockRequests Requests;

  /// Guards what follows, the segments' lines, and what workers have for the slow path.
  mutable std::mutex Guard;
  /// Changed by the communication thread alone, which needs no lock to read it.
  SegmentList<Segment> Segments;
  FramePhase Phase = FramePhase::Closed;
  std::atomic<bool> IsEntranceOpen{ false };
  int CommunicationThread = 0;
  std::string Cause;
  PageCache Cache;
  std::deque<BlockWant> Wanted;
  /// Some may have become wanted, or come, since they were queued.
  std::deque<BlockWant> Foreseen;
  PrefetchLedger Prefetches;
  /// Of Wanted and Foreseen; lets Service look without the lock.
  std::atomic<std::size_t> QueuedCount{ 0 };
  std::vector<Stopped> Waiting;
  /// Of the listening thread; the communication thread fails the frame for it.
  std::exception_ptr ListenersFailure;
  std::condition_variable HasClosed; ///< or was cancelled: Phase is Open no more
  bool HasZeros = false;             ///< there are lines that are Zeroed
  /// Runs of neighbouring cached blocks: each takes mappings of the process.
  std::size_t Runs = 0;
  std::size_t LargestRuns = 0;
  /// A block stays at least this long, so that the threads that were woken for it get to read it.
  static constexpr std::chrono::microseconds ShortestHold{ 10 };
  static constexpr std::chrono::microseconds LongestHold{ 4000 };
  Clock::duration Hold = ShortestHold;
  StoreCounters Frame;
  WorkerCounters Strangers; ///< faults of threads that did not enter
};

} // namespace dsm

#endif
