// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/ObjectStoreInternals.h"

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
    line.Referenced.store(1, std::memory_order_relaxed);
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
  if (line.State == LineState::Absent)
  {
    line.MoveTo(LineState::Wanted);
    this->Wanted.push_back(Want{ &segment, id });
    this->WantedCount.store(this->Wanted.size(), std::memory_order_release);
  }
  else
  {
    ++worker.Slow.Joins;
  }
  ++line.Waiters;
  worker.WaitsFor = &line;
  worker.Epoch.store(Worker::Offline, std::memory_order_release);
  this->Messages.WakeUp();
  worker.Woken.wait(lock,
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

void ObjectStore::Internals::WakeAll()
{
  for (const auto& worker : this->Workers)
  {
    worker->Woken.notify_one();
  }
}

// -- Between frames --------------------------------------------------------------------------------

void ObjectStore::Internals::Configure(const Settings& settings)
{
  if (settings.Workers < 1 || settings.Workers > std::numeric_limits<std::uint16_t>::max())
  {
    throw Error("A rank cannot trace with " + std::to_string(settings.Workers) +
      " threads. Set the number of threads (DSMThreads) to 0 for an automatic choice, or to at "
      "least 1.");
  }
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("The settings of a store cannot change within a frame.");
  }
  this->Current = settings;
  this->Workers.resize(static_cast<std::size_t>(settings.Workers));
  for (auto& worker : this->Workers)
  {
    if (!worker)
    {
      worker = std::make_unique<Worker>();
    }
  }
  this->Cache.SetCapacity(settings.CacheBytes);
  this->Cache.Shrink();
}

void ObjectStore::Internals::Add(std::shared_ptr<Segment> segment)
{
  this->Segments.emplace(segment->GetNumber(), std::move(segment));
}

void ObjectStore::Internals::Retire(const BlockSegment& segment)
{
  const auto found = this->Segments.find(segment.GetNumber());
  if (found == this->Segments.end() || found->second.get() != &segment)
  {
    return;
  }
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("A segment cannot be retired within a frame.");
  }
  Segment& retired = *found->second;
  retired.Retired = true;
  this->Cache.Forget(retired.Lines.get(), retired.GetDirectory().GetCount());
  this->Segments.erase(found);
}

// -- The frame, on the communication thread --------------------------------------------------------

std::size_t ObjectStore::Internals::GetLargestBlock() const
{
  std::size_t largest = 0;
  for (const auto& [number, segment] : this->Segments)
  {
    // What is all here needs no cache.
    largest =
      std::max(largest, segment->IsWhole() ? 0 : std::size_t(segment->GetDirectory().GetLargest()));
  }
  return largest;
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

void ObjectStore::Internals::BeginFrame()
{
  this->Messages.RunTogether("The frame cannot begin", [this] { this->CheckBudget(); });
  this->Messages.SetHandler(
    MessageKind::BlockRequest, [this](Message&& message) { this->Serve(message); });
  this->Messages.SetHandler(
    MessageKind::BlockReply, [this](Message&& message) { this->Receive(std::move(message)); });
  this->FrameSession = this->Messages.BeginSession();

  const std::size_t footprint = BlockCache::GetFootprint(this->GetLargestBlock());
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->SpareBytes = this->Cache.GetCapacity() / SparePart / footprint * footprint;
  this->Cache.Reclaim(this->GetOldestEpoch());
  this->Cache.ResetPeak();
  this->Frame = StoreCounters{};
  for (const auto& worker : this->Workers)
  {
    worker->Slow = WorkerCounters{};
    worker->Accesses.store(0, std::memory_order_relaxed);
  }
  this->Phase = FramePhase::Open;
}

bool ObjectStore::Internals::Service()
{
  if (this->WantedCount.load(std::memory_order_acquire) == 0 && !this->Cache.HasLimbo())
  {
    return false;
  }
  std::vector<Want> granted;
  bool any = false;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    any = this->Cache.Reclaim(this->GetOldestEpoch());
    while (!this->Wanted.empty())
    {
      BlockLine& line = this->Wanted.front().From->Lines[this->Wanted.front().Id];
      if (!this->MakeRoom(line.Bytes))
      {
        break;
      }
      line.MoveTo(LineState::Pending);
      granted.push_back(this->Wanted.front());
      this->Pending.push_back(this->Wanted.front());
      this->Wanted.pop_front();
    }
    this->WantedCount.store(this->Wanted.size(), std::memory_order_release);
  }
  for (const Want& want : granted)
  {
    this->Messages.Post(want.From->GetDirectory().GetOwner(want.Id), MessageKind::BlockRequest,
      Encode(BlockName{ want.From->GetNumber(), this->FrameSession, want.Id }));
  }
  return any || !granted.empty();
}

bool ObjectStore::Internals::MakeRoom(std::size_t blockBytes)
{
  if (this->Cache.TryReserve(blockBytes))
  {
    return true;
  }
  const std::uint64_t next = this->Store.Epoch.load(std::memory_order_relaxed) + 1;
  const std::size_t evicted = this->Cache.Evict(blockBytes, this->SpareBytes, next);
  if (evicted == 0)
  {
    return false;
  }
  this->Frame.Evictions += evicted;
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

const ObjectStore::Segment& ObjectStore::Internals::Find(
  const BlockName& name, int source, const char* deed) const
{
  const auto found = this->Segments.find(name.Segment);
  if (found == this->Segments.end() || name.Id >= found->second->GetDirectory().GetCount() ||
    name.Frame != this->FrameSession)
  {
    throw Error("Rank " + std::to_string(source) + " " + deed + " block " +
      std::to_string(name.Id) + " of segment " + std::to_string(name.Segment) + " in frame " +
      std::to_string(name.Frame) + ", which rank " + std::to_string(this->Messages.GetRank()) +
      " does not know. Do all ranks run the same build?");
  }
  return *found->second;
}

void ObjectStore::Internals::Serve(const Message& message)
{
  const auto name = Decode<BlockName>(message, MessageKind::BlockRequest);
  if (name.Frame < this->FrameSession)
  {
    return; // left over from a frame that was cancelled; its segment may be gone
  }
  const Segment& segment = this->Find(name, message.Source, "asked for");
  const BlockLine& line = segment.Lines[name.Id];
  if (segment.GetDirectory().GetOwner(name.Id) != this->Messages.GetRank())
  {
    throw Error("Rank " + std::to_string(message.Source) + " asked rank " +
      std::to_string(this->Messages.GetRank()) + " for block " + std::to_string(name.Id) +
      ", which rank " + std::to_string(segment.GetDirectory().GetOwner(name.Id)) +
      " owns. Do all ranks run the same build?");
  }
  const std::byte* const bytes = line.Address.load(std::memory_order_relaxed);
  std::vector<std::byte> reply;
  reply.reserve(line.Bytes + 3 * sizeof(BlockName)); // the transport puts its header behind
  reply.assign(bytes, bytes + line.Bytes);
  AttachTail(reply, name);
  this->Messages.Post(message.Source, MessageKind::BlockReply, std::move(reply));
  this->Frame.BytesSent += line.Bytes;
}

void ObjectStore::Internals::Receive(Message&& message)
{
  const auto name = DetachTail<BlockName>(message, MessageKind::BlockReply);
  if (name.Frame < this->FrameSession)
  {
    return;
  }
  const Segment& segment = this->Find(name, message.Source, "sent");
  BlockLine& line = segment.Lines[name.Id];
  const std::lock_guard<std::mutex> lock(this->Guard);
  const auto asked = std::find_if(this->Pending.begin(), this->Pending.end(),
    [&](const Want& want) { return want.From == &segment && want.Id == name.Id; });
  if (asked == this->Pending.end() || message.Payload.size() != line.Bytes ||
    message.Source != segment.GetDirectory().GetOwner(name.Id))
  {
    throw Error("Rank " + std::to_string(message.Source) + " sent " +
      std::to_string(message.Payload.size()) + " bytes as block " + std::to_string(name.Id) +
      ", which rank " + std::to_string(this->Messages.GetRank()) +
      " did not ask it for or knows with " + std::to_string(line.Bytes) +
      " bytes. Do all ranks run the same build?");
  }
  this->Cache.Insert(line, message.Payload.data());
  this->Pending.erase(asked);
  this->Frame.BytesReceived += line.Bytes;
  for (const auto& worker : this->Workers)
  {
    if (worker->WaitsFor == &line)
    {
      worker->Woken.notify_one();
    }
  }
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
  this->Abandon(this->Wanted);
  this->Wanted.clear();
  this->WantedCount.store(0, std::memory_order_release);
  this->WakeAll();
}

void ObjectStore::Internals::EndFrame()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase == FramePhase::Closed)
  {
    return;
  }
  this->Messages.SetHandler(MessageKind::BlockRequest, {});
  this->Messages.SetHandler(MessageKind::BlockReply, {});
  this->Phase = FramePhase::Closed;
  this->WakeAll();
  this->Abandon(this->Wanted);
  this->Wanted.clear();
  this->WantedCount.store(0, std::memory_order_release);
  for (const Want& want : this->Pending)
  {
    this->Cache.Release(want.From->Lines[want.Id].Bytes);
  }
  this->Abandon(this->Pending);
  this->Pending.clear();
  this->Cache.Reclaim(this->GetOldestEpoch());
  this->LastWorkers = this->CountWorkers();
}

void ObjectStore::Internals::Abandon(const std::deque<Want>& wants)
{
  for (const Want& want : wants)
  {
    want.From->Lines[want.Id].MoveTo(LineState::Absent);
  }
}

// -- Counters --------------------------------------------------------------------------------------

std::vector<WorkerCounters> ObjectStore::Internals::CountWorkers() const
{
  std::vector<WorkerCounters> counters;
  for (const auto& worker : this->Workers)
  {
    WorkerCounters counter = worker->Slow;
    counter.Accesses = worker->Accesses.load(std::memory_order_relaxed);
    // A miss that is being counted right now may be ahead of its access.
    counter.Hits = counter.Accesses - std::min(counter.Accesses, counter.Misses);
    counters.push_back(counter);
  }
  return counters;
}

std::vector<WorkerCounters> ObjectStore::Internals::GetWorkerCounters()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->Phase == FramePhase::Closed ? this->LastWorkers : this->CountWorkers();
}

StoreCounters ObjectStore::Internals::GetCounters()
{
  const auto workers = this->GetWorkerCounters();
  const std::lock_guard<std::mutex> lock(this->Guard);
  StoreCounters counters = this->Frame;
  for (const WorkerCounters& worker : workers)
  {
    counters.Workers += worker;
  }
  for (const auto& [number, segment] : this->Segments)
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
