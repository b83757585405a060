// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ObjectStore_h
#define dsm_ObjectStore_h

#include "DSMCore/base/Block.h"
#include "DSMCore/base/Counters.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/base/WorkerSlots.h"
#include "DSMCore/fetch/BlockRequests.h"
#include "DSMCore/fetch/BlockSource.h"
#include "DSMCore/fetch/FetchWorkers.h"
#include "DSMCore/fetch/FetchingStore.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/table/BlockLine.h"
#include "DSMCore/table/BlockTable.h"
#include "DSMCore/transport/Messenger.h"

#include <array>
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

/// The paper's object-based DSM (section 3.1): a block is reached through a table of entries. Where
/// we deviate: instead of a semaphore per block, a hit is one load of the entry's address and at
/// most one store of its reference bit; a block leaves the cache by CLOCK, and its memory is
/// reused only after every worker has passed a quiescent point.
///
/// Threads: the communication thread publishes, seals, retires and services; workers Acquire. A worker may hold a
/// pin only while it does not Acquire another block: a worker that waits holds nothing, so a cache of one block is
/// enough for any number of workers. Two blocks at once are acquired together (AcquirePair). The block of a pair
/// that is here stays while the worker waits for the other; only so many workers wait for pairs at a time that room
/// for one block is left. So a cache of two blocks is enough then.
///
/// Several stores may share a messenger; one of them at a time has a frame open.
class ObjectStore : public FetchingStore
{
public:
  struct Settings
  {
    /// Budget for remote blocks, in bytes. At least the largest block, when there are several ranks.
    std::size_t CacheBytes = std::size_t(64) << 20;
    /// Number of tracing threads.
    int Workers = 1;
    /// Ranks of one host read one another's blocks in place: such accesses are hits, and take
    /// nothing of the cache. For what is published from then on; the same on every rank.
    bool HostSharing = false;
    /// Ranks that share memory; null: determined with every publication.
    std::shared_ptr<const HostGroups> Groups = nullptr;
    /// Limits the number of workers that run: a worker gives its slot to others while it waits.
    /// Null: no limit.
    std::shared_ptr<WorkerSlots> Slots = nullptr;
    /// See Prefetch.
    bool Prefetch = true;
    /// For replies to other ranks that have not left yet, in bytes; one is always sent.
    std::size_t ReplyBytes = BlockRequests::MostReplyBytes;
  };

  using Segment = BlockTable;
  class Worker;
  class Pin;

  /// The messenger must outlive the store.
  ObjectStore(Messenger& messenger, const Settings& settings);
  ~ObjectStore();

  /// Between frames, on the communication thread; local. Drops cached blocks over a smaller budget.
  /// Throws Error within a frame and for less than one worker.
  void SetSettings(const Settings& settings);
  const Settings& GetSettings() const;

  /// Collective. Allocates this rank's blocks, feeds every rank's fragments to their owners in
  /// bounded batches, and seals. Throws the same Error on every rank when any rank fails.
  /// `progress` (may be empty) is called now and then with this rank's part done, in [0, 1].
  std::shared_ptr<BlockSegment> Publish(std::string_view what, BlockDirectory directory,
    FragmentSource& source, FragmentSink& sink, FunctionRef<void(double)> progress = {});

  /// Collective. As above, but no data move: the blocks that this rank owns are brought by `source`
  /// when they are needed, here or elsewhere, and leave memory like those of others; they count as
  /// cached. Where there are several ranks, the cache must hold one own block more. Whatever a source
  /// throws fails the frame.
  std::shared_ptr<BlockSegment> Publish(
    std::string_view what, BlockDirectory directory, std::shared_ptr<BlockSource> source);

  /// Collective in order (no message is exchanged), between frames: forgets the segment and its cached blocks. The
  /// blocks of it that this rank owns stay until the last shared pointer goes.
  void Retire(const std::shared_ptr<BlockSegment>& segment);

  /// Between frames: takes over what another store on this messenger has published, or hands it over,
  /// its cached blocks forgotten. Neither fails when room was made, which may throw std::bad_alloc.
  void MakeRoom(std::size_t count);
  void Adopt(std::shared_ptr<BlockTable> table);
  void Surrender(const BlockTable& table);

  /// Index in [0, Settings::Workers). The reference is valid until the number of workers changes.
  Worker& GetWorker(int index);

  /// Worker, between Enter and Leave: the block, resident or cached, else waits until it is fetched.
  /// The pin is valid until it goes out of scope. Throws Error after Cancel, and when it would have
  /// to wait while the worker holds another pin, has not entered, or the segment was retired.
  Pin Acquire(Worker& worker, const BlockSegment& segment, BlockId id);
  /// The same for two blocks of segments whose directories are paired (BlockDirectory::SetPaired). Both that are absent
  /// are fetched at the same time.
  std::pair<Pin, Pin> AcquirePair(Worker& worker, const BlockSegment& segment, BlockId id,
    const BlockSegment& otherSegment, BlockId otherId);

  /// Worker: it will probably need these blocks soon, the likeliest first. Where the bytes of those that are absent
  /// are decides what is done. Where the worker may read a block from the host's disk by itself, the system is
  /// advised to read it, which takes nothing of the cache; of a file's, also those that `addNeighbors` (may be
  /// empty) adds, which lie beside it in the file. Other ranks' blocks are asked for in one go, unless too much of
  /// the cache is taken by blocks that were prefetched and not used yet. Never waits; ids that there are not,
  /// blocks that are here or on their way, retired segments and frames that are not open are passed by. Returns
  /// whether any block was not here.
  bool Prefetch(const BlockSegment& segment, const BlockId* ids, std::size_t count,
    FunctionRef<void(BlockId, std::vector<BlockId>&)> addNeighbors = {});

  /// Worker: holds no pin; memory of blocks evicted before may be reused. Call between tiles; it
  /// costs two loads as long as nothing was evicted.
  void Quiesce(Worker& worker);
  /// Worker: starts, stops to take part; while stopped it does not delay reclamation.
  void Enter(Worker& worker);
  void Leave(Worker& worker);

private:
  class Internals;

  /// The way of a miss; waits for the block's bytes.
  const std::byte* Wait(Worker& worker, const Segment& segment, BlockId id);
  /// The same for a pair.
  std::array<const std::byte*, 2> WaitForPair(Worker& worker, const Segment& segment, BlockId id,
    const Segment& otherSegment, BlockId otherId);
  /// Counts an access. Returns the block's bytes; null when it is absent.
  static const std::byte* Look(Worker& worker, BlockLine& line);
  /// Passes a quiescent point, the epoch having moved.
  void Announce(Worker& worker);

  /// Moves on when blocks are evicted. Their addresses are cleared before the new epoch is stored (release). So a
  /// worker that has loaded it (acquire) and announces it can no longer reach them, and its announcement (release)
  /// follows its last read of them. Once the communication thread sees (acquire) that every worker is offline or
  /// has announced the epoch, their memory is free. A worker comes online under the store's lock, under which
  /// blocks are evicted and freed too: either it is seen, or it sees.
  alignas(64) std::atomic<std::uint64_t> Epoch{ 1 };
  std::unique_ptr<Internals> Self;
};

/// A tracing thread's part of the store. On a cache line of its own.
class alignas(64) ObjectStore::Worker final : public FetchWorker
{
  friend class ObjectStore;
  friend class ObjectStore::Pin;

  static constexpr std::uint64_t Offline = 0;

  /// The last epoch that the worker announced, or Offline. Only the worker writes.
  std::atomic<std::uint64_t> Epoch{ Offline };
  std::uint32_t Pins = 0;
};

/// Keeps a block's bytes where they are. Belongs to the worker's thread; movable, so that it can be
/// returned.
class ObjectStore::Pin
{
public:
  Pin(Pin&& other) noexcept
    : Data(other.Data)
    , Bytes(other.Bytes)
    , Holder(std::exchange(other.Holder, nullptr))
  {
  }
  Pin(const Pin&) = delete;
  Pin& operator=(const Pin&) = delete;
  Pin& operator=(Pin&&) = delete;
  ~Pin()
  {
    if (this->Holder)
    {
      --this->Holder->Pins;
    }
  }

  /// Aligned to BlockAlignment.
  const std::byte* GetData() const { return this->Data; }
  std::size_t GetBytes() const { return this->Bytes; }

private:
  friend class ObjectStore;

  Pin(const std::byte* data, std::size_t bytes, Worker& holder)
    : Data(data)
    , Bytes(bytes)
    , Holder(&holder)
  {
    ++holder.Pins;
  }

  const std::byte* Data;
  std::size_t Bytes;
  Worker* Holder;
};

inline const std::byte* ObjectStore::Look(Worker& worker, BlockLine& line)
{
  worker.Accesses.store(
    worker.Accesses.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  const std::byte* const address = line.Address.load(std::memory_order_acquire);
  // Tested first: a store on every hit would take the line away from the other workers' caches.
  if (address && line.Use.load(std::memory_order_relaxed) != BlockUse::Recent)
  {
    line.Use.store(BlockUse::Recent, std::memory_order_relaxed);
  }
  return address;
}

inline ObjectStore::Pin ObjectStore::Acquire(
  Worker& worker, const BlockSegment& segment, BlockId id)
{
  const Segment& self = static_cast<const Segment&>(segment);
  BlockLine& line = self.Lines[id];
  const std::byte* address = Look(worker, line);
  if (!address)
  {
    address = this->Wait(worker, self, id);
  }
  return Pin(address, line.Bytes, worker);
}

inline std::pair<ObjectStore::Pin, ObjectStore::Pin> ObjectStore::AcquirePair(Worker& worker,
  const BlockSegment& segment, BlockId id, const BlockSegment& otherSegment, BlockId otherId)
{
  const Segment& one = static_cast<const Segment&>(segment);
  const Segment& other = static_cast<const Segment&>(otherSegment);
  BlockLine& line = one.Lines[id];
  BlockLine& otherLine = other.Lines[otherId];
  std::array<const std::byte*, 2> addresses{ Look(worker, line), Look(worker, otherLine) };
  if (!addresses[0] || !addresses[1])
  {
    addresses = this->WaitForPair(worker, one, id, other, otherId);
  }
  return { Pin(addresses[0], line.Bytes, worker), Pin(addresses[1], otherLine.Bytes, worker) };
}

inline void ObjectStore::Quiesce(Worker& worker)
{
  if (worker.Epoch.load(std::memory_order_relaxed) != this->Epoch.load(std::memory_order_relaxed))
  {
    this->Announce(worker);
  }
}

} // namespace dsm

#endif
