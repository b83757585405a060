// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PagedStoreInternals_h
#define dsm_PagedStoreInternals_h

#include "DSMCore/fetch/BlockFetcher.h"
#include "DSMCore/memory/AddressRange.h"
#include "DSMCore/paged/PageCache.h"
#include "DSMCore/paged/PageFaults.h"
#include "DSMCore/paged/PagedStore.h"

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace dsm
{

/// The store's slow paths: a block lands in its pages at once (PageFaults::Place), is shown by its hint,
/// and is evicted by taking hint and pages away; threads wait for it politely or in a fault.
///
/// A listening thread takes the faults: it queues them, passes on those outside the store, and after a cancellation
/// satisfies them with zeros, so that no thread waits for a communication thread that has left the frame.
class PagedStore::Internals final : public BlockFetcher
{
public:
  Internals(Messenger& messenger, const Settings& settings);
  ~Internals() override;

  void Wait(Worker& worker, const Segment& segment, BlockId id);
  bool MayPrefetch() const override;
  void Enter(Worker& worker);
  void Leave(Worker& worker);

  void Configure(const Settings& settings);
  /// Throws Error when the system refuses userfaultfd, or this process is a fork of the store's.
  void CheckFaults() const;
  /// The same where blocks fault though there is one rank.
  void RequireFaults();

  /// Any thread: whether a frame runs that was not cancelled.
  bool IsEntranceOpen() const { return this->Entrance.load(std::memory_order_acquire); }

  Settings Current;
  /// Null with one rank, unless sources bring blocks, and if the system refuses it.
  std::shared_ptr<PageFaults> Faults;
  std::string FaultsRefusal;

private:
  using Clock = std::chrono::steady_clock;

  static const Segment& GetSegment(const BlockWant& block)
  {
    return *static_cast<const Segment*>(block.From);
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

  // -- See BlockFetcher --
  LineStatus& GetLine(const BlockWant& block) const override
  {
    return GetSegment(block).Lines[block.Id];
  }
  std::size_t CountFootprint(std::size_t bytes) const override
  {
    return AddressRange::RoundUpToPages(bytes);
  }
  const std::byte* FindOwned(const BlockWant& block) const override;
  BlockSource* FindSource(const BlockWant& block) const override
  {
    return GetSegment(block).Source.get();
  }
  void CheckBudget() const override;
  bool MakeRoom(const BlockWant& block) override;
  void GiveRoomBack(const BlockWant& block) noexcept override;
  void Land(const BlockWant& block, const std::byte* bytes, BlockMemory& memory) override;
  void Show(const BlockWant& block, BlockMemory& memory) override;
  std::vector<BlockId> ListCached(const BlockSegment& segment) const override;
  void Forget(const BlockSegment& segment) override;
  void Forget(const BlockSegment& segment, const std::vector<bool>& which) override;
  bool IsUnused(const BlockWant& block) const override;
  bool Settle(const BlockWant& block) override;
  void AddCounters(StoreCounters& counters) const override;
  void Opened() override;
  void Closing() override;
  void Closed() override;
  bool BeginService() override;
  bool NeedsService() const override { return this->HasListenerFailed.load(); }
  void EndService() override;

  // -- Under the lock --
  /// Puts what was evicted behind Evicted; false when there is nothing.
  bool TryEvict();
  void MarkEvicted(const PageCache::Slot& slot);
  void RemoveZeros();

  void CreateFaults();
  bool IsAnyFromSource() const;
  /// The largest block that comes and goes.
  std::size_t GetLargestBlock() const;

  pid_t Process;
  std::thread Listener;
  /// Their pages are still to be removed. Communication thread only.
  std::vector<PageCache::Slot> Evicted;

  // Under the lock, but for what is atomic.
  std::atomic<bool> Entrance{ false };
  int CommunicationThread = 0;
  PageCache Cache;
  std::vector<Stopped> Waiting;
  /// Exception of the listening thread; the communication thread fails the frame with it.
  std::exception_ptr ListenersFailure;
  std::atomic<bool> HasListenerFailed{ false };
  std::condition_variable HasClosed; ///< notified when Phase is no longer Open
  bool HasZeros = false;             ///< there are lines that are Zeroed
  /// A block stays at least this long, so that the threads that were woken for it get to read it.
  static constexpr std::chrono::microseconds ShortestHold{ 10 };
  static constexpr std::chrono::microseconds LongestHold{ 4000 };
  Clock::duration Hold = ShortestHold;
  WorkerCounters Strangers; ///< faults of threads that did not enter
};

} // namespace dsm

#endif
