// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ReplicatedStore_h
#define dsm_ReplicatedStore_h

#include "DSMCore/base/Block.h"
#include "DSMCore/base/Counters.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/publish/SegmentList.h"
#include "DSMCore/table/BlockLine.h"
#include "DSMCore/table/BlockTable.h"
#include "DSMCore/transport/Messenger.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace dsm
{

/// Every block on every rank: the yardstick by which the paper measures its two organizations, and
/// the fast way when it fits. An access is one load of a table; there are no misses, and within a
/// frame no messages. With host sharing the ranks of a host have one copy between them.
///
/// Has the members of ObjectStore, with the same rules of threads and collectives.
class ReplicatedStore
{
public:
  struct Settings
  {
    /// Number of tracing threads.
    int Workers = 1;
    /// See ObjectStore.
    bool HostSharing = false;
    /// Ranks that share memory; null: determined with every publication.
    std::shared_ptr<const HostGroups> Groups = nullptr;
  };

  using Segment = BlockTable;
  class Worker;
  class Pin;

  /// The messenger must outlive the store.
  ReplicatedStore(Messenger& messenger, const Settings& settings);
  ~ReplicatedStore();
  ReplicatedStore(const ReplicatedStore&) = delete;
  ReplicatedStore& operator=(const ReplicatedStore&) = delete;

  /// Between frames, on the communication thread; local. Throws Error within a frame and for less than one worker.
  /// Segments that are published already keep their memory.
  void SetSettings(const Settings& settings);
  const Settings& GetSettings() const { return this->Current; }

  /// Collective. As ObjectStore::Publish; then the owners send their blocks to all others, in
  /// bounded batches. Throws Error, on every rank, when the host of any has no memory for it.
  std::shared_ptr<BlockSegment> Publish(std::string_view what, BlockDirectory directory,
    FragmentSource& source, FragmentSink& sink, FunctionRef<void(double)> progress = {});

  /// Collective in order, between frames.
  void Retire(const std::shared_ptr<BlockSegment>& segment);

  /// See ObjectStore; copies the blocks again.
  void Refresh(
    std::string_view what, const BlockSegment& segment, const std::vector<bool>& changed);

  /// See ObjectStore. To adopt is collective: the segment is replicated, or the same Error thrown everywhere, and
  /// not adopted. To surrender drops the copies.
  void MakeRoom(std::size_t count);
  void Adopt(std::shared_ptr<BlockTable> table);
  void Surrender(BlockTable& table);

  /// See ObjectStore; always.
  static constexpr bool MayBeginFrame() { return true; }
  /// Local. Resets the counters of the frame. Nothing has to be agreed on.
  void BeginFrame(bool agreed = false);
  /// Nothing to do.
  bool Service() { return false; }
  /// Does nothing: no worker ever waits.
  void Cancel(const std::string&) {}
  bool Drain() { return true; }
  void EndFrame();

  Worker& GetWorker(int index);

  /// Worker: the block. The pin is valid as long as the segment is published.
  Pin Acquire(Worker& worker, const BlockSegment& segment, BlockId id);
  std::pair<Pin, Pin> AcquirePair(Worker& worker, const BlockSegment& segment, BlockId id,
    const BlockSegment& otherSegment, BlockId otherId);
  bool MayPrefetch() const { return false; }
  bool Prefetch(const BlockSegment&, const BlockId*, std::size_t,
    FunctionRef<void(BlockId, std::vector<BlockId>&)> = {})
  {
    return false;
  }
  void Quiesce(Worker&) {}
  void Enter(Worker&) {}
  void Leave(Worker&) {}

  std::uint64_t GetMisses(const Worker&) const { return 0; }
  StoreCounters GetCounters() const;
  static constexpr std::uint64_t GetBytesFrom(int /*owner*/) { return 0; }
  std::vector<WorkerCounters> GetWorkerCounters() const;

private:
  Messenger& Messages;
  Settings Current;
  std::vector<std::unique_ptr<Worker>> Workers;
  SegmentList<BlockTable> Segments;
  bool InFrame = false;
};

/// A tracing thread's part of the store. On a cache line of its own.
class alignas(64) ReplicatedStore::Worker
{
public:
  Worker() = default;
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

private:
  friend class ReplicatedStore;

  /// Only the worker writes; atomic, so that the communication thread may read it meanwhile.
  std::atomic<std::uint64_t> Accesses{ 0 };
};

/// A block's bytes.
class ReplicatedStore::Pin
{
public:
  /// Aligned to BlockAlignment.
  const std::byte* GetData() const { return this->Data; }
  std::size_t GetBytes() const { return this->Bytes; }

private:
  friend class ReplicatedStore;

  Pin(const std::byte* data, std::size_t bytes)
    : Data(data)
    , Bytes(bytes)
  {
  }

  const std::byte* Data;
  std::size_t Bytes;
};

inline ReplicatedStore::Pin ReplicatedStore::Acquire(
  Worker& worker, const BlockSegment& segment, BlockId id)
{
  const BlockLine& line = static_cast<const BlockTable&>(segment).Lines[id];
  worker.Accesses.store(
    worker.Accesses.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  return Pin(line.Address.load(std::memory_order_relaxed), line.Bytes);
}

inline std::pair<ReplicatedStore::Pin, ReplicatedStore::Pin> ReplicatedStore::AcquirePair(
  Worker& worker, const BlockSegment& segment, BlockId id, const BlockSegment& otherSegment,
  BlockId otherId)
{
  return { this->Acquire(worker, segment, id), this->Acquire(worker, otherSegment, otherId) };
}

} // namespace dsm

#endif
