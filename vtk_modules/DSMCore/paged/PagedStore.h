// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PagedStore_h
#define dsm_PagedStore_h

#include "DSMCore/base/Block.h"
#include "DSMCore/base/Counters.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/base/WorkerSlots.h"
#include "DSMCore/fetch/BlockRequests.h"
#include "DSMCore/fetch/BlockSource.h"
#include "DSMCore/fetch/FetchWorkers.h"
#include "DSMCore/fetch/FetchingStore.h"
#include "DSMCore/fetch/LineStatus.h"
#include "DSMCore/memory/AddressRange.h"
#include "DSMCore/paged/PageFaults.h"
#include "DSMCore/paged/PageHint.h"
#include "DSMCore/paged/PageLayout.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/transport/Messenger.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dsm
{

/// The paper's page-based DSM (section 3.2): a segment is a range of addresses, a block is the bytes
/// at base + offset, and a page that is not here faults until it is fetched. Where we deviate: any
/// number of threads, since a page is seen whole or not at all; 64 bits; and the entry from which
/// Acquire takes the address (which is quicker than to compute it, blocks being grouped by owner)
/// says in a bit whether the block is here: if not, the worker waits without a fault, which is
/// quicker too. The bit is only a hint, and the fault always the last resort: a block may be evicted
/// while it is read, and then faults again. With Settings::PureFaulting the bit says that all is
/// here, and everything faults, as in the paper.
///
/// Threads: the communication thread publishes, seals, retires and services; workers Acquire.
/// - Remote blocks may be read within a frame only, by any thread but the communication thread,
///   which would wait for itself: such reads end the process by SIGSEGV, as any bad address does.
/// - No address of a block may be handed to a system call or to MPI: only a load can wait.
/// - A worker that waits in a fault when the frame is cancelled reads zeros from then on; its next
///   Acquire throws.
/// - A process made by fork must leave the store alone; reading remote blocks ends it by SIGSEGV. The child can
///   read blocks that this rank owns. It never disturbs the parent.
///
/// Several stores may share a messenger; one of them at a time has a frame open.
class PagedStore : public FetchingStore
{
public:
  struct Settings
  {
    /// Budget for remote blocks, in bytes, each rounded up to whole pages. At least the largest
    /// block, when there are several ranks.
    std::size_t CacheBytes = std::size_t(64) << 20;
    /// Number of tracing threads.
    int Workers = 1;
    /// Never look whether a block is here before it is read.
    bool PureFaulting = false;
    /// Limits the number of workers that run: a worker gives its slot to others while it waits.
    /// Null: no limit.
    std::shared_ptr<WorkerSlots> Slots = nullptr;
    /// See Prefetch.
    bool Prefetch = true;
    /// For replies to other ranks that have not left yet, in bytes; one is always sent.
    std::size_t ReplyBytes = BlockRequests::MostReplyBytes;
  };

  class Segment;
  class Worker;
  class Pin;

  /// The messenger must outlive the store.
  PagedStore(Messenger& messenger, const Settings& settings);
  ~PagedStore();

  /// Between frames, on the communication thread; local. Drops cached blocks over a smaller budget.
  /// Throws Error within a frame, and for less than one worker.
  void SetSettings(const Settings& settings);
  const Settings& GetSettings() const;

  /// Collective. Sets out addresses for all blocks and memory for this rank's, feeds every rank's
  /// fragments to their owners in bounded batches, and seals. Throws the same Error on every rank
  /// when any rank fails; too when the system of a rank refuses userfaultfd (see PageFaults).
  /// `progress` (may be empty) is called now and then with this rank's part done, in [0, 1].
  std::shared_ptr<BlockSegment> Publish(std::string_view what, BlockDirectory directory,
    FragmentSource& source, FragmentSink& sink, FunctionRef<void(double)> progress = {});

  /// Collective. As above, but no data move: the blocks that this rank owns are brought by `source`, as in
  /// ObjectStore. Then blocks fault with one rank, too.
  std::shared_ptr<BlockSegment> Publish(
    std::string_view what, BlockDirectory directory, std::shared_ptr<BlockSource> source);

  /// Collective in order (no message is exchanged), between frames: forgets the segment and its cached blocks. The
  /// blocks of it that this rank owns stay until the last shared pointer goes.
  void Retire(const std::shared_ptr<BlockSegment>& segment);

  /// Index in [0, Settings::Workers). The reference is valid until the number of workers changes.
  Worker& GetWorker(int index);

  /// Worker, between Enter and Leave: the block's address. Waits for a block that is known to be
  /// absent. Throws Error after Cancel, and for another rank's block when the worker has not
  /// entered, outside of a frame, and when the segment was retired.
  Pin Acquire(Worker& worker, const BlockSegment& segment, BlockId id);
  /// The same for two blocks. Either may be evicted while the other is waited for, and then faults when it is read.
  std::pair<Pin, Pin> AcquirePair(Worker& worker, const BlockSegment& segment, BlockId id,
    const BlockSegment& otherSegment, BlockId otherId);

  /// See ObjectStore. With Settings::PureFaulting nothing is prefetched, as in the paper.
  bool Prefetch(const BlockSegment& segment, const BlockId* ids, std::size_t count,
    FunctionRef<void(BlockId, std::vector<BlockId>&)> addNeighbors = {});

  /// Nothing needs it here.
  void Quiesce(Worker&) {}
  /// Worker: starts, stops to take part.
  void Enter(Worker& worker);
  void Leave(Worker& worker);

private:
  friend class PageCache;
  class Internals;

  /// The long way of an access: waits for the block, or finds that it must not be read.
  Pin Admit(Worker& worker, const Segment& segment, BlockId id);

  std::unique_ptr<Internals> Self;
};

/// The addresses of all blocks, and the memory of those that this rank owns.
class PagedStore::Segment final : public BlockSegment
{
public:
  /// Sets out zeroed memory for the blocks of `rank`, unless there is a source that brings them. `faults`
  /// may be null where all is owned. Throws Error, std::bad_alloc.
  Segment(std::uint32_t number, BlockDirectory directory, int rank, int ranks,
    std::shared_ptr<PageFaults> faults, std::shared_ptr<BlockSource> source = nullptr);
  ~Segment() override;
  void ForEachResident(const Visit& visit) const override;
  /// In whole pages.
  std::uint64_t GetResidentBytes() const override;
  std::byte* GetOwned(BlockId id) const override { return this->GetAddress(id); }
  /// From now on this rank's blocks are read only, and those of others fault.
  void Seal() override;
  void Unseal() override { this->Protect(true); }
  void Reseal() override { this->Protect(false); }

  /// Returns the bytes that the tables for finding the blocks take on every rank.
  static std::uint64_t CountTableBytes(const BlockDirectory& directory)
  {
    constexpr std::size_t entry = sizeof(std::atomic<std::uintptr_t>) + sizeof(LineStatus);
    return directory.GetCount() * (PageLayout::BytesPerBlock + entry) + directory.GetOwnBytes();
  }

private:
  friend class PageCache;
  friend class PagedStore;

  /// Makes the blocks that this rank owns writable or read only. Throws std::bad_alloc.
  void Protect(bool writable);
  std::byte* GetAddress(BlockId id) const { return this->Base + this->Layout.GetOffset(id); }
  PageHint GetHint(BlockId id) const;
  void SetHint(BlockId id, PageHint hint) const;
  /// A worker uses a block that is idle or was prefetched; false when it is neither.
  bool TryMarkRecent(BlockId id) const;
  /// Returns whether a worker never waits for the block: this rank owns it, or it is empty.
  bool IsAlwaysHere(BlockId id) const;
  /// Sets all hints by where the blocks stand. With `pure`, they say that all is here.
  void ResetHints(bool pure);
  /// Lets accesses through, or makes every one take the long way.
  void Admit(bool open);
  /// For good.
  bool IsOwned(BlockId id) const
  {
    return !this->Source && this->GetDirectory().GetOwner(id) == this->Rank;
  }
  /// Offsets at which the blocks that this rank keeps permanently begin and end.
  std::uint64_t GetOwnedBegin() const
  {
    return this->Source ? 0 : this->Layout.GetShareBegin(this->Rank);
  }
  std::uint64_t GetOwnedEnd() const
  {
    return this->Source ? 0 : this->Layout.GetShareEnd(this->Rank);
  }
  /// Returns whether the address is in a page of a block that may be evicted, and sets `id` to that
  /// block.
  bool FindRemote(const std::byte* address, BlockId& id) const;
  bool Contains(const std::byte* address) const;
  /// Makes the blocks of other ranks unreadable.
  void Detach();

  PageLayout Layout;
  AddressRange Range;
  std::byte* Base = nullptr;
  /// Address and hint of every block.
  std::unique_ptr<std::atomic<std::uintptr_t>[]> Entries;
  /// As many zeros, hence without hints, for workers while the store is closed. They take no memory.
  AddressRange ClosedEntries;
  std::atomic<const std::atomic<std::uintptr_t>*> VisibleEntries{ nullptr };
  bool IsPure = false;
  std::unique_ptr<LineStatus[]> Lines; ///< under the store's lock
  int Rank = 0;
  std::shared_ptr<BlockSource> Source; ///< null: own blocks stay
  std::shared_ptr<PageFaults> Handler;
  std::vector<std::byte*> Attached;
};

/// A tracing thread's part of the store. On a cache line of its own.
class alignas(64) PagedStore::Worker final : public FetchWorker
{
  friend class PagedStore;

  /// The kernel's number of the thread between Enter and Leave, 0 otherwise.
  std::atomic<int> Thread{ 0 };
  const std::byte* LastFault = nullptr; ///< under the store's lock
};

/// A block's bytes. They need not be held: what is evicted comes back when it is read.
class PagedStore::Pin
{
public:
  /// Aligned to the page size.
  const std::byte* GetData() const { return this->Data; }
  std::size_t GetBytes() const { return this->From->GetDirectory().GetBytes(this->Id); }

private:
  friend class PagedStore;

  Pin(const std::byte* data, const Segment& from, BlockId id)
    : Data(data)
    , From(&from)
    , Id(id)
  {
  }

  const std::byte* Data;
  const Segment* From;
  BlockId Id;
};

inline PagedStore::Pin PagedStore::Acquire(Worker& worker, const BlockSegment& segment, BlockId id)
{
  const Segment& self = static_cast<const Segment&>(segment);
  worker.Accesses.store(
    worker.Accesses.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  const std::uintptr_t entry =
    self.VisibleEntries.load(std::memory_order_acquire)[id].load(std::memory_order_relaxed);
  constexpr auto recent = static_cast<std::uintptr_t>(PageHint::Recent);
  if ((entry & recent) == 0)
  {
    return this->Admit(worker, self, id);
  }
  return Pin(reinterpret_cast<const std::byte*>(entry - recent), self, id);
}

inline std::pair<PagedStore::Pin, PagedStore::Pin> PagedStore::AcquirePair(Worker& worker,
  const BlockSegment& segment, BlockId id, const BlockSegment& otherSegment, BlockId otherId)
{
  return { this->Acquire(worker, segment, id), this->Acquire(worker, otherSegment, otherId) };
}

} // namespace dsm

#endif
