// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/ObjectStoreInternals.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace dsm
{

namespace
{

/// The cache is divided by it for what is evicted ahead of need when room must be made: freeing waits
/// for every worker's quiescent point, and waiting once for several blocks is cheaper than once for
/// each.
constexpr std::size_t SpareDivisor = 32;

} // namespace

ObjectStore::Internals::Internals(
  ObjectStore& store, Messenger& messenger, const Settings& settings)
  : BlockFetcher(messenger)
  , Store(store)
{
  this->Configure(settings);
}

ObjectStore::Internals::~Internals()
{
  this->EndFrame();
}

// -- Workers ---------------------------------------------------------------------------------------

void ObjectStore::Internals::Enter(Worker& worker)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  worker.Epoch.store(this->Store.Epoch.load(std::memory_order_relaxed), std::memory_order_release);
}

void ObjectStore::Internals::Leave(Worker& worker)
{
  worker.Epoch.store(Worker::Offline, std::memory_order_release);
  this->Messages.WakeUp(); // memory may have come free
}

void ObjectStore::Internals::CheckMiss(const Worker& worker)
{
  if (worker.Pins != 0)
  {
    throw Error("A worker requested a block while it held another. This is a bug in the tracer.");
  }
  if (worker.Epoch.load(std::memory_order_relaxed) == Worker::Offline)
  {
    throw Error(
      "A worker missed a block before it entered the frame. This is a bug in the tracer.");
  }
}

void ObjectStore::Internals::CheckOpen(Worker& worker, const BlockWant& block)
{
  if (!this->IsOpenFor(*block.From))
  {
    ++worker.Slow.Misses;
    this->Refuse(*block.From);
  }
}

const std::byte* ObjectStore::Internals::Wait(Worker& worker, const Segment& segment, BlockId id)
{
  CheckMiss(worker);
  const BlockWant block{ &segment, id };
  BlockLine& line = segment.Lines[id];
  std::unique_lock<std::mutex> lock(this->Guard);
  if (const std::byte* const address = line.Address.load(std::memory_order_relaxed))
  {
    line.Use.store(BlockUse::Recent, std::memory_order_relaxed);
    return address; // it came in the meantime: a hit after all
  }
  this->CheckOpen(worker, block);
  worker.Epoch.store(Worker::Offline, std::memory_order_release);
  if (!this->ReadAtOnce(worker, block, lock))
  {
    this->CheckOpen(worker, block);
    this->WaitFor(worker, { block }, lock, this->Current.Slots.get(), true);
  }
  // Online again under the lock: from now on the block may be evicted, but its memory waits for this
  // worker.
  worker.Epoch.store(this->Store.Epoch.load(std::memory_order_relaxed), std::memory_order_release);
  // The guard was held by the thread that stored the address: its bytes are visible.
  const std::byte* const address = line.Address.load(std::memory_order_relaxed);
  if (!address)
  {
    this->Refuse(segment);
  }
  return address;
}

std::array<const std::byte*, 2> ObjectStore::Internals::WaitForPair(
  Worker& worker, const BlockWant& one, const BlockWant& other)
{
  CheckMiss(worker);
  if (!one.From->GetDirectory().IsPaired() || !other.From->GetDirectory().IsPaired())
  {
    throw Error("A worker requested two blocks that are not paired. This is a bug in the tracer.");
  }
  const auto areHere = [&] { return this->GetLine(one).IsHere() && this->GetLine(other).IsHere(); };
  std::unique_lock<std::mutex> lock(this->Guard);
  if (!areHere())
  {
    this->CheckOpen(worker, one);
    this->CheckOpen(worker, other);
    worker.Epoch.store(Worker::Offline, std::memory_order_release);
    for (const BlockWant& block : { one, other })
    {
      if (!this->GetLine(block).IsHere())
      {
        this->ReadAtOnce(worker, block, lock);
      }
    }
    if (!areHere())
    {
      this->WaitInTurn(worker, one, other, lock);
    }
    // As in Wait.
    worker.Epoch.store(
      this->Store.Epoch.load(std::memory_order_relaxed), std::memory_order_release);
  }
  std::array<const std::byte*, 2> addresses;
  for (std::size_t index = 0; index < addresses.size(); ++index)
  {
    const BlockWant& block = index == 0 ? one : other;
    BlockLine& line = GetBlockLine(block);
    addresses[index] = line.Address.load(std::memory_order_relaxed);
    if (!addresses[index])
    {
      this->Refuse(*block.From);
    }
    line.Use.store(BlockUse::Recent, std::memory_order_relaxed);
  }
  return addresses;
}

void ObjectStore::Internals::WaitInTurn(
  Worker& worker, const BlockWant& one, const BlockWant& other, std::unique_lock<std::mutex>& lock)
{
  // Others may take the turn while this worker waits for a slot.
  while (this->PairsWaiting == this->MostPairs && this->Phase == FramePhase::Open)
  {
    WaitWithoutSlot(this->Current.Slots.get(), lock, worker.Woken,
      [this] { return this->PairsWaiting < this->MostPairs || this->Phase != FramePhase::Open; });
  }
  this->CheckOpen(worker, one);
  this->CheckOpen(worker, other);
  ++this->PairsWaiting;
  this->WaitFor(worker, { one, other }, lock, this->Current.Slots.get(), true);
  if (this->PairsWaiting-- == this->MostPairs)
  {
    this->Workers.WakeAll();
  }
}

bool ObjectStore::Internals::MayPrefetch() const
{
  return this->Current.Prefetch && this->GetLargestBlock() > 0;
}

// -- Between frames --------------------------------------------------------------------------------

void ObjectStore::Internals::Configure(const Settings& settings)
{
  CheckWorkerCount(settings.Workers);
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("The settings of a store cannot change during a frame.");
  }
  this->Current = settings;
  this->Workers.Resize<Worker>(settings.Workers);
  this->Requests.SetReplyBytes(settings.ReplyBytes);
  this->Cache.SetCapacity(settings.CacheBytes);
  this->Cache.Shrink();
}

std::vector<BlockId> ObjectStore::Internals::ListCached(const BlockSegment& segment) const
{
  return this->Cache.List(
    static_cast<const Segment&>(segment).Lines.get(), segment.GetDirectory().GetCount());
}

void ObjectStore::Internals::Forget(const BlockSegment& segment)
{
  this->Cache.Forget(
    static_cast<const Segment&>(segment).Lines.get(), segment.GetDirectory().GetCount());
}

void ObjectStore::Internals::Forget(const BlockSegment& segment, const std::vector<bool>& which)
{
  this->Cache.Forget(static_cast<const Segment&>(segment).Lines.get(), which.size(), &which);
}

std::size_t ObjectStore::Internals::GetLargestBlock() const
{
  std::size_t largest = 0;
  for (const auto& segment : this->Segments)
  {
    // A segment that is completely here needs no cache.
    const bool isWhole = static_cast<const Segment&>(*segment).IsWhole();
    largest = std::max(largest, isWhole ? 0 : std::size_t(segment->GetDirectory().GetLargest()));
  }
  return largest;
}

// -- Blocks, on the communication thread -----------------------------------------------------------

const std::byte* ObjectStore::Internals::FindOwned(const BlockWant& block) const
{
  return GetBlockLine(block).Address.load(std::memory_order_acquire); // a worker may have read it
}

bool ObjectStore::Internals::IsOwned(const BlockWant& block) const
{
  return GetSegment(block).ReadByAll || this->BlockFetcher::IsOwned(block);
}

BlockSource* ObjectStore::Internals::FindSource(const BlockWant& block) const
{
  return GetSegment(block).Source.get();
}

BlockSource* ObjectStore::Internals::FindSourceForWorkers(const BlockWant& block) const
{
  const BlockDirectory& directory = block.From->GetDirectory();
  // The ranks of a host have the system's cache in common, so each may read what another one owns: nothing is read
  // from the disk twice.
  const HostGroups* const groups = this->Current.Groups.get();
  const bool isShared = !directory.IsOnOwnersDisk() && groups &&
    groups->AreTogether(this->Messages.GetRank(), directory.GetOwner(block.Id));
  return isShared || this->IsOwned(block) ? GetSegment(block).Source.get() : nullptr;
}

bool ObjectStore::Internals::TakeRoom(const BlockWant& block)
{
  return this->Cache.TryReserve(GetBlockLine(block).Bytes);
}

bool ObjectStore::Internals::MakeRoom(const BlockWant& block)
{
  const std::size_t blockBytes = GetBlockLine(block).Bytes;
  if (this->Cache.TryReserve(blockBytes))
  {
    return true;
  }
  const std::uint64_t next = this->Store.Epoch.load(std::memory_order_relaxed) + 1;
  const BlockCache::Evictions evicted = this->Cache.Evict(blockBytes, this->SpareBytes, next);
  if (evicted.Count == 0)
  {
    return false;
  }
  this->CountEvictions(evicted.Count, evicted.Unused);
  this->Store.Epoch.store(next, std::memory_order_release);
  this->Cache.Reclaim(this->GetOldestEpoch());
  return this->Cache.TryReserve(blockBytes);
}

void ObjectStore::Internals::GiveRoomBack(const BlockWant& block) noexcept
{
  this->Cache.Release(GetBlockLine(block).Bytes);
}

void ObjectStore::Internals::Land(
  const BlockWant& block, const std::byte* bytes, BlockMemory& memory)
{
  if (!memory)
  {
    const std::size_t blockBytes = GetBlockLine(block).Bytes;
    memory = AllocateBlock(blockBytes);
    std::copy_n(bytes, blockBytes, memory.get());
  }
}

void ObjectStore::Internals::Show(const BlockWant& block, BlockMemory& memory)
{
  this->Cache.Insert(GetBlockLine(block), std::move(memory));
}

std::uint64_t ObjectStore::Internals::GetOldestEpoch() const
{
  std::uint64_t oldest = std::numeric_limits<std::uint64_t>::max();
  for (const auto& worker : this->Workers)
  {
    const std::uint64_t epoch =
      static_cast<const Worker&>(*worker).Epoch.load(std::memory_order_acquire);
    if (epoch != Worker::Offline)
    {
      oldest = std::min(oldest, epoch);
    }
  }
  return oldest;
}

bool ObjectStore::Internals::IsUnused(const BlockWant& block) const
{
  return GetBlockLine(block).Use.load(std::memory_order_relaxed) == BlockUse::Prefetched;
}

bool ObjectStore::Internals::Settle(const BlockWant& block)
{
  BlockLine& line = GetBlockLine(block);
  auto unused = BlockUse::Prefetched;
  return line.Use.compare_exchange_strong(unused, BlockUse::Idle) &&
    line.State == LineState::Cached;
}

// -- Moments of a frame ----------------------------------------------------------------------------

void ObjectStore::Internals::Opened()
{
  const std::size_t footprint = GetBlockFootprint(this->GetLargestBlock());
  this->SpareBytes = this->Cache.GetCapacity() / SpareDivisor / footprint * footprint;
  this->Cache.Reclaim(this->GetOldestEpoch());
  this->Cache.ResetPeak();
  this->RoomForOthers = this->Cache.GetCapacity() - this->GetRoomForOwn();
  // Each may keep one block that is here; one more has to fit, and one of the rank's own.
  const std::size_t fitting =
    footprint > 0 ? (this->Cache.GetCapacity() - this->GetRoomForOwn()) / footprint : 0;
  this->MostPairs = std::max<std::size_t>(fitting, 2) - 1;
  this->Prefetches.BeginFrame(this->Cache.GetCapacity());
}

bool ObjectStore::Internals::BeginService()
{
  return this->Cache.Reclaim(this->GetOldestEpoch());
}

void ObjectStore::Internals::Closed()
{
  this->Cache.Reclaim(this->GetOldestEpoch());
}

void ObjectStore::Internals::AddCounters(StoreCounters& counters) const
{
  for (const auto& segment : this->Segments)
  {
    counters.SharedBytes += static_cast<const Segment&>(*segment).GetSharedBytes();
    counters.TableBytes += BlockTable::CountTableBytes(segment->GetDirectory());
  }
  counters.CachedBytes = this->Cache.GetUsed();
  counters.PeakCachedBytes = this->Cache.GetPeak();
  counters.CacheCapacity = this->Cache.GetCapacity();
}

} // namespace dsm
