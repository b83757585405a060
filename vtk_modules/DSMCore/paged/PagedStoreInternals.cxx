// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/PagedStoreInternals.h"

#include "DSMCore/base/NanosecondsSince.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace dsm
{

namespace
{

int GetThread()
{
  static thread_local const int number = static_cast<int>(syscall(SYS_gettid));
  return number;
}

} // namespace

PagedStore::Internals::Internals(Messenger& messenger, const Settings& settings)
  : BlockFetcher(messenger)
  , Process(getpid())
{
  this->Configure(settings);
}

PagedStore::Internals::~Internals()
{
  this->EndFrame();
  this->StopListening();
  for (const auto& segment : this->Segments)
  {
    static_cast<Segment&>(*segment).Detach(); // it may live on
  }
}

// -- Workers ---------------------------------------------------------------------------------------

void PagedStore::Internals::Enter(Worker& worker)
{
  worker.Thread.store(GetThread(), std::memory_order_relaxed);
}

void PagedStore::Internals::Leave(Worker& worker)
{
  worker.Thread.store(0, std::memory_order_relaxed);
}

void PagedStore::Internals::Wait(Worker& worker, const Segment& segment, BlockId id)
{
  std::unique_lock<std::mutex> lock(this->Guard);
  if (segment.IsAlwaysHere(id) && this->Phase != FramePhase::Cancelled)
  {
    return;
  }
  if (!this->IsOpenFor(segment))
  {
    this->Refuse(segment);
  }
  const int thread = worker.Thread.load(std::memory_order_relaxed);
  if (thread == 0 || thread == this->CommunicationThread)
  {
    throw Error(thread == 0
        ? "A worker missed a block before it entered the frame. This is a bug in the tracer."
        : "The communication thread missed a block that only it can request. This is a bug in the "
          "tracer.");
  }
  if (segment.Lines[id].State == LineState::Cached) // it came in the meantime: a hit after all
  {
    segment.SetHint(id, PageHint::Recent);
    return;
  }
  // The block may be evicted while the worker waits for a slot: who has the slots may wait for room, in a
  // fault, and would keep them for ever. It is fetched again then, by the fault of who reads it.
  this->WaitFor(worker, { { &segment, id } }, lock, this->Current.Slots.get(), false);
  if (this->Phase != FramePhase::Open)
  {
    this->Refuse(segment);
  }
}

bool PagedStore::Internals::MayPrefetch() const
{
  return this->Current.Prefetch && !this->Current.PureFaulting &&
    (this->Messages.GetSize() > 1 || this->IsAnyFromSource());
}

bool PagedStore::Internals::IsAnyFromSource() const
{
  return std::any_of(this->Segments.begin(), this->Segments.end(),
    [](const auto& segment) { return segment->GetDirectory().IsFromSource(); });
}

// -- Between frames --------------------------------------------------------------------------------

void PagedStore::Internals::Configure(const Settings& settings)
{
  CheckWorkerCount(settings.Workers);
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("The settings of a store cannot change during a frame.");
  }
  if (this->Messages.GetSize() > 1 && !this->Faults)
  {
    this->FaultsRefusal.clear();
    try
    {
      this->CreateFaults();
    }
    catch (const std::exception& exception)
    {
      // Told by Publish, on all ranks: another one may have had more luck.
      this->FaultsRefusal = exception.what();
    }
  }
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    this->Current = settings;
    this->Workers.Resize<Worker>(settings.Workers);
    this->Requests.SetReplyBytes(settings.ReplyBytes);
    this->Cache.SetCapacity(settings.CacheBytes);
    while (this->Cache.GetUsed() > settings.CacheBytes && this->TryEvict())
    {
    }
  }
  this->EndService();
}

void PagedStore::Internals::CheckFaults() const
{
  if (getpid() != this->Process)
  {
    throw Error("A forked process cannot use the paged memory of its parent. Start a new program, "
                "or choose the object based memory organization (DSMMemoryOrganization).");
  }
  if (!this->FaultsRefusal.empty())
  {
    throw Error(this->FaultsRefusal);
  }
}

void PagedStore::Internals::CreateFaults()
{
  this->Faults = std::make_shared<PageFaults>();
  try
  {
    this->StartListening();
  }
  catch (...)
  {
    this->Faults.reset();
    throw;
  }
}

void PagedStore::Internals::RequireFaults()
{
  this->CheckFaults();
  if (!this->Faults)
  {
    this->CreateFaults();
  }
}

std::vector<BlockId> PagedStore::Internals::ListCached(const BlockSegment& segment) const
{
  return this->Cache.List(static_cast<const Segment&>(segment));
}

void PagedStore::Internals::Forget(const BlockSegment& segment)
{
  this->Cache.Forget(static_cast<const Segment&>(segment),
    [this](const PageCache::Slot& slot) { this->MarkEvicted(slot); });
}

void PagedStore::Internals::Forget(const BlockSegment& segment, const std::vector<bool>& which)
{
  const Segment& self = static_cast<const Segment&>(segment);
  this->Evicted.reserve(this->Evicted.size() + which.size());
  const auto visit = [&](const PageCache::Slot& slot)
  {
    if (!self.IsPure)
    {
      self.SetHint(slot.Id, PageHint::Absent);
    }
    this->MarkEvicted(slot);
    this->Evicted.push_back(slot);
  };
  this->Cache.Forget(self, visit, &which);
}

void PagedStore::Internals::CheckBudget() const
{
  this->CheckFaults();
  this->CheckCache(this->Current.CacheBytes, this->GetLargestBlock());
}

std::size_t PagedStore::Internals::GetLargestBlock() const
{
  std::size_t largest = 0;
  for (const auto& segment : this->Segments)
  {
    const BlockDirectory& directory = segment->GetDirectory();
    const bool stays = this->Messages.GetSize() == 1 && !directory.IsFromSource();
    largest = std::max(largest, stays ? 0 : std::size_t(directory.GetLargest()));
  }
  return largest;
}

const std::byte* PagedStore::Internals::FindOwned(const BlockWant& block) const
{
  const Segment& segment = GetSegment(block);
  const std::lock_guard<std::mutex> lock(this->Guard);
  const bool isHere =
    segment.IsAlwaysHere(block.Id) || segment.Lines[block.Id].State == LineState::Cached;
  return isHere ? segment.GetAddress(block.Id) : nullptr;
}

// -- Blocks, on the communication thread -----------------------------------------------------------

bool PagedStore::Internals::MakeRoom(const BlockWant& block)
{
  const std::size_t footprint = this->GetFootprint(block);
  while (!this->Cache.TryReserve(footprint))
  {
    if (!this->TryEvict())
    {
      return false;
    }
  }
  return true;
}

void PagedStore::Internals::GiveRoomBack(const BlockWant& block) noexcept
{
  this->Cache.Release(this->GetFootprint(block));
}

bool PagedStore::Internals::TryEvict()
{
  const auto latest = this->Phase == FramePhase::Open ? Clock::now() - this->Hold : Clock::now();
  this->Evicted.emplace_back();
  PageCache::Slot& slot = this->Evicted.back();
  if (!this->Cache.TryEvict(latest, slot))
  {
    this->Evicted.pop_back();
    return false;
  }
  this->MarkEvicted(slot);
  this->CountEvictions(1, slot.WasUnused ? 1 : 0);
  return true;
}

void PagedStore::Internals::MarkEvicted(const PageCache::Slot& slot)
{
  LineStatus& line = slot.From->Lines[slot.Id];
  line.MoveTo(LineState::Absent);
  line.Use.store(BlockUse::Idle, std::memory_order_relaxed);
}

void PagedStore::Internals::EndService()
{
  // An evicted block may be wanted again already, but only this thread can fetch it.
  for (const PageCache::Slot& slot : this->Evicted)
  {
    this->Faults->Remove(slot.From->GetAddress(slot.Id), slot.Footprint);
  }
  this->Evicted.clear();
}

void PagedStore::Internals::Land(const BlockWant& block, const std::byte* bytes, BlockMemory&)
{
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    this->Cache.PrepareSlot();
  }
  const Segment& segment = GetSegment(block);
  this->Faults->Place(
    segment.GetAddress(block.Id), bytes, segment.GetDirectory().GetBytes(block.Id));
}

void PagedStore::Internals::Show(const BlockWant& block, BlockMemory&)
{
  const Segment& segment = GetSegment(block);
  this->Cache.Insert({ &segment, block.Id, this->GetFootprint(block), Clock::now() });
  LineStatus& line = this->GetLine(block);
  line.MoveTo(LineState::Cached);
  if (!segment.IsPure)
  {
    const bool isUnused = line.Use.load(std::memory_order_relaxed) == BlockUse::Prefetched;
    segment.SetHint(block.Id, isUnused ? PageHint::Prefetched : PageHint::Recent);
  }
  const auto isOther = [&](const Stopped& stopped)
  { return stopped.From != &segment || stopped.Id != block.Id; };
  const auto first = std::partition(this->Waiting.begin(), this->Waiting.end(), isOther);
  std::for_each(first, this->Waiting.end(),
    [this](const Stopped& stopped)
    {
      WorkerCounters& counters = stopped.Who ? stopped.Who->Slow : this->Strangers;
      counters.WaitNanoseconds += NanosecondsSince(stopped.Since);
      this->Faults->Answer(stopped.Fault, PageFaults::Reply::Placed);
    });
  this->Waiting.erase(first, this->Waiting.end());
}

bool PagedStore::Internals::IsUnused(const BlockWant& block) const
{
  const LineStatus& line = this->GetLine(block);
  return line.Use.load(std::memory_order_relaxed) == BlockUse::Prefetched &&
    (line.State != LineState::Cached ||
      GetSegment(block).GetHint(block.Id) == PageHint::Prefetched);
}

bool PagedStore::Internals::Settle(const BlockWant& block)
{
  LineStatus& line = this->GetLine(block);
  const bool isUnused = line.State == LineState::Cached && this->IsUnused(block);
  line.Use.store(BlockUse::Idle, std::memory_order_relaxed);
  if (isUnused)
  {
    GetSegment(block).SetHint(block.Id, PageHint::Idle);
  }
  return isUnused;
}

// -- Moments of a frame ----------------------------------------------------------------------------

void PagedStore::Internals::Opened()
{
  this->CommunicationThread = GetThread();
  this->Hold = ShortestHold;
  this->Cache.ResetPeak();
  this->RoomForOthers = this->Cache.GetCapacity() - this->GetRoomForOwn();
  this->Prefetches.BeginFrame(this->Cache.GetCapacity());
  this->Strangers = WorkerCounters{};
  for (const auto& worker : this->Workers)
  {
    static_cast<Worker&>(*worker).LastFault = nullptr;
  }
  for (const auto& each : this->Segments)
  {
    Segment& segment = static_cast<Segment&>(*each);
    if (segment.IsPure != this->Current.PureFaulting)
    {
      segment.ResetHints(this->Current.PureFaulting);
    }
    segment.Admit(true);
  }
  this->Entrance.store(true, std::memory_order_release);
}

bool PagedStore::Internals::BeginService()
{
  if (this->HasListenerFailed.exchange(false))
  {
    std::rethrow_exception(std::exchange(this->ListenersFailure, nullptr));
  }
  return false;
}

void PagedStore::Internals::Closing()
{
  this->Entrance.store(false, std::memory_order_release);
  for (const auto& segment : this->Segments)
  {
    static_cast<Segment&>(*segment).Admit(false);
  }
}

void PagedStore::Internals::Closed()
{
  this->HasClosed.notify_all();
  this->HasListenerFailed = false;
  this->ListenersFailure = nullptr;
  if (!this->Faults)
  {
    return;
  }
  this->EndService(); // work that an exception may have left
  if (this->Phase == FramePhase::Cancelled)
  {
    for (const Stopped& stopped : this->Waiting)
    {
      this->TakeCancelled(stopped.Fault, *stopped.From, stopped.Id);
    }
    this->Waiting.clear();
    return;
  }
  for (const Stopped& stopped : this->Waiting) // though all workers should have stopped
  {
    this->Faults->Answer(stopped.Fault, PageFaults::Reply::Refused);
  }
  this->Waiting.clear();
  if (std::exchange(this->HasZeros, false))
  {
    this->RemoveZeros();
  }
}

void PagedStore::Internals::RemoveZeros()
{
  for (const auto& each : this->Segments)
  {
    const Segment& segment = static_cast<const Segment&>(*each);
    for (BlockId id = 0; id < segment.GetDirectory().GetCount(); ++id)
    {
      if (segment.Lines[id].State == LineState::Zeroed)
      {
        this->Faults->Remove(segment.GetAddress(id), segment.Layout.GetFootprint(id));
        segment.Lines[id].MoveTo(LineState::Absent);
      }
    }
  }
}

void PagedStore::Internals::AddCounters(StoreCounters& counters) const
{
  for (const auto& segment : this->Segments)
  {
    counters.TableBytes += Segment::CountTableBytes(segment->GetDirectory());
  }
  counters.Workers += this->Strangers;
  counters.CachedBytes = this->Cache.GetUsed();
  counters.PeakCachedBytes = this->Cache.GetPeak();
  counters.CacheCapacity = this->Cache.GetCapacity();
}

} // namespace dsm
