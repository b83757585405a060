// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/ObjectStoreInternals.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

namespace dsm
{

namespace
{

/// Part of the cache that is evicted ahead of need when room must be made: freeing waits for every
/// worker's quiescent point, and waiting once for several blocks is cheaper than once for each.
constexpr std::size_t SparePart = 32;

} // namespace

ObjectStore::Internals::Internals(
  ObjectStore& store, Messenger& messenger, const Settings& settings)
  : Messages(messenger)
  , Store(store)
  , Requests(messenger, this->MakeCallbacks())
{
  this->Configure(settings);
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

const std::byte* ObjectStore::Internals::Wait(Worker& worker, const Segment& segment, BlockId id)
{
  if (worker.Pins != 0)
  {
    throw Error("A worker that holds a block would wait for another; it must let go of the first. "
                "This is a defect of the tracer.");
  }
  if (worker.Epoch.load(std::memory_order_relaxed) == Worker::Offline)
  {
    throw Error("A worker missed a block without having entered the frame. This is a defect of "
                "the tracer.");
  }
  BlockLine& line = segment.Lines[id];
  std::unique_lock<std::mutex> lock(this->Guard);
  if (const std::byte* const address = line.Address.load(std::memory_order_relaxed))
  {
    line.Use.store(BlockUse::Recent, std::memory_order_relaxed);
    return address; // it came in the meantime: a hit after all
  }
  ++worker.Slow.Misses;
  if (segment.Retired)
  {
    throw Error("A block of a retired segment was read. This is a defect of the tracer.");
  }
  if (this->Phase != FramePhase::Open)
  {
    throw Error(this->Phase == FramePhase::Cancelled
        ? this->Cause
        : "A block of another rank was read outside of a frame. This is a defect of the tracer.");
  }

  const auto start = std::chrono::steady_clock::now();
  const bool wasForeseen = line.Use.load(std::memory_order_relaxed) == BlockUse::Prefetched;
  if (line.State == LineState::Absent || line.State == LineState::Foreseen)
  {
    this->Wanted.push_back({ &segment, id });
    line.MoveTo(LineState::Wanted);
    this->UpdateQueuedCount();
  }
  else
  {
    ++worker.Slow.Joins;
    if (wasForeseen)
    {
      this->Prefetches.CountJoin();
    }
  }
  if (wasForeseen)
  {
    line.Use.store(BlockUse::Idle, std::memory_order_relaxed);
  }
  ++line.Waiters;
  worker.WaitsFor = &line;
  worker.Epoch.store(Worker::Offline, std::memory_order_release);
  this->Messages.WakeUp();
  WaitWithoutSlot(this->Current.Slots.get(), lock, worker.Woken,
    [&]
    { return line.Address.load(std::memory_order_relaxed) || this->Phase != FramePhase::Open; });
  // Online again before the waiter is taken off: from then on the block may be evicted, but its
  // memory waits for this worker.
  worker.Epoch.store(this->Store.Epoch.load(std::memory_order_relaxed), std::memory_order_release);
  worker.WaitsFor = nullptr;
  --line.Waiters;
  worker.Slow.WaitNanoseconds += static_cast<std::uint64_t>(
    std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start)
      .count());
  // The guard was held by the thread that stored the address: its bytes are visible.
  const std::byte* const address = line.Address.load(std::memory_order_relaxed);
  if (!address)
  {
    throw Error(this->Phase == FramePhase::Cancelled
        ? this->Cause
        : "The frame was closed while a worker waited for a block. This is a defect of the "
          "renderer.");
  }
  return address;
}

void ObjectStore::Internals::Prefetch(const Segment& segment, const BlockId* ids, std::size_t count)
{
  const auto isUnused = [](const BlockWant& block)
  { return GetLine(block).Use.load(std::memory_order_relaxed) == BlockUse::Prefetched; };
  bool any = false;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    if (this->Phase != FramePhase::Open || segment.Retired || !this->Current.Prefetch)
    {
      return;
    }
    for (const BlockId* id = ids; id != ids + count; ++id)
    {
      if (*id >= segment.GetDirectory().GetCount() || segment.Lines[*id].State != LineState::Absent)
      {
        continue;
      }
      BlockLine& line = segment.Lines[*id];
      const BlockWant want{ &segment, *id };
      if (!this->Prefetches.TryAdd(want, BlockCache::GetFootprint(line.Bytes), isUnused))
      {
        break;
      }
      this->Foreseen.push_back(want);
      line.MoveTo(LineState::Foreseen);
      line.Use.store(BlockUse::Prefetched, std::memory_order_relaxed);
      any = true;
    }
    this->UpdateQueuedCount();
  }
  if (any)
  {
    this->Messages.WakeUp();
  }
}

// -- Between frames --------------------------------------------------------------------------------

void ObjectStore::Internals::Configure(const Settings& settings)
{
  CheckWorkerCount(settings.Workers);
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("The settings of a store cannot change within a frame.");
  }
  this->Current = settings;
  this->Workers.Resize(settings.Workers);
  this->Cache.SetCapacity(settings.CacheBytes);
  this->Cache.Shrink();
}

void ObjectStore::Internals::PrepareToAdd()
{
  if (this->IsInFrame())
  {
    throw Error("Blocks cannot be published within a frame.");
  }
  this->Segments.MakeRoom(1);
}

void ObjectStore::Internals::Add(std::shared_ptr<Segment> segment)
{
  this->Segments.Add(std::move(segment));
}

void ObjectStore::Internals::Retire(const BlockSegment& segment)
{
  if (!this->Segments.Has(segment))
  {
    return;
  }
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("A segment cannot be retired within a frame.");
  }
  const std::shared_ptr<Segment> retired = this->Segments.Remove(segment);
  retired->Retired = true;
  this->Cache.Forget(retired->Lines.get(), retired->GetDirectory().GetCount());
}

// -- The frame, on the communication thread --------------------------------------------------------

std::size_t ObjectStore::Internals::GetLargestBlock() const
{
  std::size_t largest = 0;
  for (const auto& segment : this->Segments)
  {
    // What is all here needs no cache.
    largest =
      std::max(largest, segment->IsWhole() ? 0 : std::size_t(segment->GetDirectory().GetLargest()));
  }
  return largest;
}

bool ObjectStore::Internals::MayPrefetch() const
{
  return this->Current.Prefetch && this->GetLargestBlock() > 0;
}

void ObjectStore::Internals::CheckBudget() const
{
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("The previous frame of the store was not ended.");
  }
  const std::size_t largest = this->GetLargestBlock();
  if (largest > 0 && this->Current.CacheBytes < BlockCache::GetFootprint(largest))
  {
    throw Error("The cache of " + std::to_string(this->Current.CacheBytes) +
      " bytes is smaller than one brick (" + std::to_string(BlockCache::GetFootprint(largest)) +
      " bytes). Raise the cache size (DSMCacheSize).");
  }
}

bool ObjectStore::Internals::MayBeginFrame() const
{
  try
  {
    this->CheckBudget();
    return true;
  }
  catch (const Error&)
  {
    return false; // BeginFrame will say why, on every rank
  }
}

void ObjectStore::Internals::BeginFrame(bool agreed)
{
  if (!agreed)
  {
    this->Messages.RunTogether("The frame cannot begin", [this] { this->CheckBudget(); });
  }
  this->Requests.BeginFrame();

  const std::size_t footprint = BlockCache::GetFootprint(this->GetLargestBlock());
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->SpareBytes = this->Cache.GetCapacity() / SparePart / footprint * footprint;
  this->Cache.Reclaim(this->GetOldestEpoch());
  this->Cache.ResetPeak();
  this->Frame = StoreCounters{};
  this->Prefetches.BeginFrame(this->Cache.GetCapacity());
  this->Workers.BeginFrame();
  this->Phase = FramePhase::Open;
}

bool ObjectStore::Internals::Service()
{
  if (this->QueuedCount.load(std::memory_order_acquire) == 0 && !this->Cache.HasLimbo())
  {
    return false;
  }
  bool any = false;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    any = this->Cache.Reclaim(this->GetOldestEpoch());
    this->AskForWanted();
    if (this->Wanted.empty())
    {
      this->AskForForeseen();
    }
    this->UpdateQueuedCount();
  }
  return this->Requests.Send() || any;
}

void ObjectStore::Internals::AskForWanted()
{
  while (!this->Wanted.empty())
  {
    BlockLine& line = GetLine(this->Wanted.front());
    if (!this->MakeRoom(line.Bytes))
    {
      return;
    }
    this->Ask(this->Wanted.front());
    this->Wanted.pop_front();
  }
}

void ObjectStore::Internals::AskForForeseen()
{
  while (!this->Foreseen.empty())
  {
    BlockLine& line = GetLine(this->Foreseen.front());
    if (line.State == LineState::Foreseen)
    {
      if (!this->MakeRoom(line.Bytes))
      {
        return;
      }
      this->Ask(this->Foreseen.front());
      ++this->Frame.Prefetches;
    }
    this->Foreseen.pop_front();
  }
}

void ObjectStore::Internals::Ask(const BlockWant& want)
{
  BlockLine& line = GetLine(want);
  try
  {
    this->Requests.Add(want);
  }
  catch (...)
  {
    this->Cache.Release(line.Bytes);
    throw;
  }
  line.MoveTo(LineState::Pending);
}

void ObjectStore::Internals::UpdateQueuedCount()
{
  this->QueuedCount.store(this->Wanted.size() + this->Foreseen.size(), std::memory_order_release);
}

bool ObjectStore::Internals::MakeRoom(std::size_t blockBytes)
{
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
  this->Frame.Evictions += evicted.Count;
  this->Prefetches.CountLosses(evicted.Unused);
  this->Store.Epoch.store(next, std::memory_order_release);
  this->Cache.Reclaim(this->GetOldestEpoch());
  return this->Cache.TryReserve(blockBytes);
}

std::uint64_t ObjectStore::Internals::GetOldestEpoch() const
{
  std::uint64_t oldest = std::numeric_limits<std::uint64_t>::max();
  for (const auto& worker : this->Workers)
  {
    const std::uint64_t epoch = worker->Epoch.load(std::memory_order_acquire);
    if (epoch != Worker::Offline)
    {
      oldest = std::min(oldest, epoch);
    }
  }
  return oldest;
}

BlockRequests::Callbacks ObjectStore::Internals::MakeCallbacks()
{
  BlockRequests::Callbacks callbacks;
  callbacks.Find = [this](std::uint32_t number) { return this->Segments.Find(number); };
  callbacks.GetOwned = [](const BlockWant& block)
  { return GetLine(block).Address.load(std::memory_order_relaxed); };
  callbacks.Take = [this](const BlockWant& block, const std::byte* bytes)
  { this->Take(block, bytes); };
  return callbacks;
}

void ObjectStore::Internals::Take(const BlockWant& block, const std::byte* bytes)
{
  BlockLine& line = GetLine(block);
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Cache.Insert(line, bytes);
  if (line.Use.load(std::memory_order_relaxed) == BlockUse::Prefetched)
  {
    this->Prefetches.CountArrival();
  }
  this->Workers.WakeThoseThatWaitFor(line);
}

void ObjectStore::Internals::Cancel(const std::string& cause)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase != FramePhase::Open)
  {
    return; // the first cause stands
  }
  this->Phase = FramePhase::Cancelled;
  this->Cause = cause;
  this->AbandonWanted();
  this->AbandonForeseen();
  this->Workers.WakeAll();
}

bool ObjectStore::Internals::Drain()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->AbandonForeseen();
  return this->Phase != FramePhase::Open || this->Requests.GetPendingCount() == 0;
}

void ObjectStore::Internals::EndFrame()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase == FramePhase::Closed)
  {
    return;
  }
  this->Requests.EndFrame();
  this->Phase = FramePhase::Closed;
  this->Workers.WakeAll();
  this->AbandonWanted();
  this->AbandonForeseen();
  for (const BlockWant& want : this->Requests.Abandon())
  {
    this->Cache.Release(GetLine(want).Bytes);
    GetLine(want).MoveTo(LineState::Absent);
  }
  this->Frame.PrefetchesUsed = this->Prefetches.EndFrame(
    [](const BlockWant& block)
    {
      BlockLine& line = GetLine(block);
      auto unused = BlockUse::Prefetched;
      return line.Use.compare_exchange_strong(unused, BlockUse::Idle) &&
        line.State == LineState::Cached;
    });
  this->Cache.Reclaim(this->GetOldestEpoch());
  this->Workers.EndFrame();
}

void ObjectStore::Internals::AbandonWanted()
{
  for (const BlockWant& want : this->Wanted)
  {
    GetLine(want).MoveTo(LineState::Absent);
  }
  this->Wanted.clear();
  this->UpdateQueuedCount();
}

void ObjectStore::Internals::AbandonForeseen()
{
  for (const BlockWant& want : this->Foreseen)
  {
    BlockLine& line = GetLine(want);
    if (line.State == LineState::Foreseen)
    {
      line.MoveTo(LineState::Absent);
      line.Use.store(BlockUse::Idle, std::memory_order_relaxed);
    }
  }
  this->Foreseen.clear();
  this->UpdateQueuedCount();
}

// -- Counters --------------------------------------------------------------------------------------

std::vector<WorkerCounters> ObjectStore::Internals::GetWorkerCounters()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->Workers.GetCounters(this->IsInFrame());
}

std::uint64_t ObjectStore::Internals::GetMisses(const Worker& worker) const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return worker.Slow.Misses;
}

StoreCounters ObjectStore::Internals::GetCounters()
{
  const auto workers = this->GetWorkerCounters();
  const std::lock_guard<std::mutex> lock(this->Guard);
  StoreCounters counters = this->Frame;
  counters.Requests = this->Requests.GetCount();
  counters.BytesSent = this->Requests.GetBytesSent();
  counters.BytesReceived = this->Requests.GetBytesReceived();
  for (const WorkerCounters& worker : workers)
  {
    counters.Workers += worker;
  }
  for (const auto& segment : this->Segments)
  {
    counters.ResidentBytes += segment->GetResidentBytes();
    counters.SharedBytes += segment->GetSharedBytes();
  }
  counters.CachedBytes = this->Cache.GetUsed();
  counters.PeakCachedBytes = this->Cache.GetPeak();
  counters.CacheCapacity = this->Cache.GetCapacity();
  return counters;
}

} // namespace dsm
