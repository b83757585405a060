// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/PagedStoreInternals.h"

#include "DSMCore/paged/SegmentationSignal.h"

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

std::uint64_t NanosecondsSince(std::chrono::steady_clock::time_point start)
{
  return static_cast<std::uint64_t>(
    std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start)
      .count());
}

} // namespace

PagedStore::Internals::Internals(Messenger& messenger, const Settings& settings)
  : Messages(messenger)
  , Process(getpid())
  , Requests(messenger, this->MakeCallbacks())
{
  this->Configure(settings);
}

PagedStore::Internals::~Internals()
{
  this->EndFrame();
  this->StopListening();
  for (const auto& segment : this->Segments)
  {
    segment->Detach(); // it may live on
    segment->Retired = true;
  }
}

// -- Workers ---------------------------------------------------------------------------------------

void PagedStore::Internals::Enter(Worker& worker)
{
  if (this->Faults && this->Faults->GetKind() == FaultHandling::Signal)
  {
    SegmentationSignal::Unblock();
  }
  worker.Thread.store(GetThread(), std::memory_order_relaxed);
}

void PagedStore::Internals::Leave(Worker& worker)
{
  worker.Thread.store(0, std::memory_order_relaxed);
}

void PagedStore::Internals::Refuse(const Segment& segment) const
{
  if (this->Phase == FramePhase::Cancelled)
  {
    throw Error(this->Cause);
  }
  throw Error(segment.Retired
      ? "A block of a retired segment was read. This is a defect of the tracer."
      : "A block of another rank was read outside of a frame. This is a defect of the tracer.");
}

void PagedStore::Internals::Wait(Worker& worker, const Segment& segment, BlockId id)
{
  std::unique_lock<std::mutex> lock(this->Guard);
  PageLine& line = segment.Lines[id];
  if (segment.IsAlwaysHere(id) && this->Phase != FramePhase::Cancelled)
  {
    return;
  }
  if (this->Phase != FramePhase::Open || segment.Retired)
  {
    this->Refuse(segment);
  }
  const int thread = worker.Thread.load(std::memory_order_relaxed);
  if (thread == 0 || thread == this->CommunicationThread)
  {
    throw Error(thread == 0
        ? "A worker missed a block without having entered the frame. This is a defect of the "
          "tracer."
        : "The communication thread missed a block, for which it alone can send. This is a defect "
          "of the tracer.");
  }
  if (line.State == PageState::Cached) // it came in the meantime: a hit after all
  {
    segment.SetHint(id, PageHint::Recent);
    return;
  }

  const auto start = Clock::now();
  ++worker.Slow.Misses;
  worker.Slow.Joins += this->Request(segment, id) ? 1 : 0;
  ++line.Waiters;
  worker.WaitsFor = &line;
  this->Messages.WakeUp();
  // The block may be evicted while the worker waits for a slot: who has the slots may wait for room, in a
  // fault, and would keep them for ever. It is fetched again then, by the fault of who reads it.
  WaitWithoutSlot(
    this->Current.Slots.get(), lock, worker.Woken,
    [&] { return line.State == PageState::Cached || this->Phase != FramePhase::Open; },
    [&]
    {
      worker.WaitsFor = nullptr;
      --line.Waiters;
    });
  worker.Slow.WaitNanoseconds += NanosecondsSince(start);
  if (this->Phase != FramePhase::Open)
  {
    this->Refuse(segment);
  }
}

bool PagedStore::Internals::Request(const Segment& segment, BlockId id)
{
  PageLine& line = segment.Lines[id];
  const bool wasForeseen = std::exchange(line.IsPrefetched, false);
  if (line.State != PageState::Absent && line.State != PageState::Foreseen)
  {
    if (wasForeseen)
    {
      this->Prefetches.CountJoin();
    }
    return true;
  }
  this->Wanted.push_back({ &segment, id });
  line.MoveTo(PageState::Wanted);
  this->UpdateQueuedCount();
  return false;
}

void PagedStore::Internals::Prefetch(const Segment& segment, const BlockId* ids, std::size_t count)
{
  const auto isUnused = [](const BlockWant& block)
  {
    const PageLine& line = GetLine(block);
    return line.IsPrefetched &&
      (line.State != PageState::Cached ||
        GetSegment(block).GetHint(block.Id) == PageHint::Prefetched);
  };
  bool any = false;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    if (this->Phase != FramePhase::Open || segment.Retired || !this->MayPrefetch())
    {
      return;
    }
    for (const BlockId* id = ids; id != ids + count; ++id)
    {
      if (*id >= segment.GetDirectory().GetCount() ||
        segment.Lines[*id].State != PageState::Absent || segment.IsAlwaysHere(*id))
      {
        continue;
      }
      PageLine& line = segment.Lines[*id];
      const BlockWant want{ &segment, *id };
      if (!this->Prefetches.TryAdd(want, GetFootprint(want), isUnused))
      {
        break;
      }
      this->Foreseen.push_back(want);
      line.MoveTo(PageState::Foreseen);
      line.IsPrefetched = true;
      any = true;
    }
    this->UpdateQueuedCount();
  }
  if (any)
  {
    this->Messages.WakeUp();
  }
}

bool PagedStore::Internals::MayPrefetch() const
{
  return this->Current.Prefetch && !this->Current.PureFaulting && this->Messages.GetSize() > 1;
}

// -- Between frames --------------------------------------------------------------------------------

void PagedStore::Internals::Configure(const Settings& settings)
{
  CheckWorkerCount(settings.Workers);
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("The settings of a store cannot change within a frame.");
  }
  const bool changes = settings.Handling != this->Current.Handling;
  if (changes && !this->Segments.IsEmpty())
  {
    throw Error("The handling of page faults cannot change while data is loaded.");
  }
  if (this->Messages.GetSize() > 1 && (changes || !this->Faults))
  {
    this->StopListening();
    this->Faults.reset();
    this->FaultsRefusal.clear();
    try
    {
      this->Faults = PageFaults::Create(settings.Handling);
      this->StartListening();
    }
    catch (const std::exception& exception)
    {
      // Told by Publish, on all ranks: another one may have had more luck.
      this->Faults.reset();
      this->FaultsRefusal = exception.what();
    }
  }
  std::vector<PageCache::Frame> evicted;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    this->Current = settings;
    this->Workers.Resize(settings.Workers);
    this->Cache.SetCapacity(settings.CacheBytes);
    while (this->Cache.GetUsed() > settings.CacheBytes && this->TryEvict(false, evicted))
    {
    }
  }
  this->Remove(evicted);
}

void PagedStore::Internals::CheckFaults() const
{
  if (getpid() != this->Process)
  {
    throw Error("A process made by fork cannot use the paged memory of its parent. Start a new "
                "program, or choose the object based memory organisation "
                "(DSMMemoryOrganization).");
  }
  if (!this->FaultsRefusal.empty())
  {
    throw Error(this->FaultsRefusal);
  }
}

void PagedStore::Internals::PrepareToAdd()
{
  if (this->IsInFrame())
  {
    throw Error("Blocks cannot be published within a frame.");
  }
  this->CheckFaults();
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Segments.MakeRoom(1);
}

void PagedStore::Internals::Add(std::shared_ptr<Segment> segment)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Segments.Add(std::move(segment));
}

void PagedStore::Internals::Retire(const BlockSegment& segment)
{
  if (!this->Segments.Has(segment))
  {
    return;
  }
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("A segment cannot be retired within a frame.");
  }
  std::shared_ptr<Segment> retired;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    retired = this->Segments.Remove(segment);
    retired->Retired = true;
    for (const PageCache::Frame& frame : this->Cache.Forget(*retired))
    {
      this->MarkEvicted(frame);
    }
  }
  retired->Detach();
}

// -- The frame, on the communication thread --------------------------------------------------------

std::size_t PagedStore::Internals::GetLargestBlock() const
{
  std::size_t largest = 0;
  for (const auto& segment : this->Segments)
  {
    largest = std::max(largest, std::size_t(segment->GetDirectory().GetLargest()));
  }
  return AddressRange::RoundUpToPages(largest);
}

void PagedStore::Internals::CheckBudget() const
{
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("The previous frame of the store was not ended.");
  }
  this->CheckFaults();
  const std::size_t largest = this->GetLargestBlock();
  if (this->Messages.GetSize() > 1 && largest > 0 && this->Current.CacheBytes < largest)
  {
    throw Error("The cache of " + std::to_string(this->Current.CacheBytes) +
      " bytes is smaller than one brick (" + std::to_string(largest) +
      " bytes in whole pages). Raise the cache size (DSMCacheSize).");
  }
}

bool PagedStore::Internals::MayBeginFrame() const
{
  try
  {
    this->CheckBudget();
    return this->Faults == nullptr;
  }
  catch (const Error&)
  {
    return false; // BeginFrame will say why, on every rank
  }
}

void PagedStore::Internals::BeginFrame(bool agreed)
{
  const auto prepare = [this]
  {
    this->CheckBudget();
    if (this->Faults)
    {
      this->LargestRuns = this->Faults->Open(this->Runs);
    }
  };
  try
  {
    if (!agreed)
    {
      this->Messages.RunTogether("The frame cannot begin", prepare);
    }
  }
  catch (...)
  {
    if (this->Faults && this->Phase == FramePhase::Closed)
    {
      this->Faults->Close();
    }
    throw;
  }
  this->Requests.BeginFrame();

  const std::lock_guard<std::mutex> lock(this->Guard);
  this->CommunicationThread = GetThread();
  this->Hold = ShortestHold;
  this->Cache.ResetPeak();
  this->Frame = StoreCounters{};
  this->Strangers = WorkerCounters{};
  this->Prefetches.BeginFrame(this->Cache.GetCapacity());
  this->Workers.BeginFrame();
  for (const auto& worker : this->Workers)
  {
    worker->LastFault = nullptr;
  }
  this->Phase = FramePhase::Open;
  for (const auto& segment : this->Segments)
  {
    if (segment->IsPure != this->Current.PureFaulting)
    {
      segment->ResetHints(this->Current.PureFaulting);
    }
    segment->Admit(true);
  }
  this->IsEntranceOpen.store(true, std::memory_order_release);
}

bool PagedStore::Internals::Service()
{
  if (this->QueuedCount.load(std::memory_order_acquire) == 0)
  {
    return false;
  }
  std::vector<PageCache::Frame> evicted;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    if (this->ListenersFailure)
    {
      const std::exception_ptr failure = std::exchange(this->ListenersFailure, nullptr);
      this->UpdateQueuedCount();
      std::rethrow_exception(failure);
    }
    this->AskForWanted(evicted);
    if (this->Wanted.empty())
    {
      this->AskForForeseen(evicted);
    }
    this->UpdateQueuedCount();
  }
  // An evicted block may be wanted again already, but only this thread can fetch it.
  this->Remove(evicted);
  return this->Requests.Send();
}

void PagedStore::Internals::AskForWanted(std::vector<PageCache::Frame>& evicted)
{
  while (!this->Wanted.empty() && this->MakeRoom(this->Wanted.front(), evicted))
  {
    this->Ask(this->Wanted.front());
    this->Wanted.pop_front();
  }
}

void PagedStore::Internals::AskForForeseen(std::vector<PageCache::Frame>& evicted)
{
  while (!this->Foreseen.empty())
  {
    const BlockWant& want = this->Foreseen.front();
    if (GetLine(want).State == PageState::Foreseen)
    {
      if (!this->MakeRoom(want, evicted))
      {
        return;
      }
      this->Ask(want);
      ++this->Frame.Prefetches;
    }
    this->Foreseen.pop_front();
  }
}

void PagedStore::Internals::Ask(const BlockWant& want)
{
  try
  {
    this->Requests.Add(want);
  }
  catch (...)
  {
    this->Cache.Release(GetFootprint(want));
    throw;
  }
  GetLine(want).MoveTo(PageState::Pending);
}

void PagedStore::Internals::UpdateQueuedCount()
{
  this->QueuedCount.store(
    this->Wanted.size() + this->Foreseen.size() + (this->ListenersFailure ? 1 : 0),
    std::memory_order_release);
}

bool PagedStore::Internals::MakeRoom(const BlockWant& want, std::vector<PageCache::Frame>& evicted)
{
  // Every block under way may become a run of its own, and one that leaves the middle of a run
  // makes two of it.
  const auto isTight = [this](std::size_t more)
  { return this->Runs + this->Requests.GetPendingCount() + more > this->LargestRuns; };
  while (isTight(1))
  {
    if (!this->TryEvict(true, evicted))
    {
      return false;
    }
  }
  const std::size_t footprint = GetFootprint(want);
  while (!this->Cache.TryReserve(footprint))
  {
    if (!this->TryEvict(isTight(2), evicted))
    {
      return false;
    }
  }
  return true;
}

bool PagedStore::Internals::TryEvict(bool atEndOfRun, std::vector<PageCache::Frame>& evicted)
{
  std::function<bool(const PageCache::Frame&)> mayGo;
  if (atEndOfRun)
  {
    mayGo = [this](const PageCache::Frame& frame)
    { return this->CountNeighbours(*frame.From, frame.Id) < 2; };
  }
  const auto latest = this->Phase == FramePhase::Open ? Clock::now() - this->Hold : Clock::now();
  PageCache::Frame frame;
  if (!this->Cache.TryEvict(latest, mayGo, frame))
  {
    return false;
  }
  this->MarkEvicted(frame);
  ++this->Frame.Evictions;
  evicted.push_back(frame);
  return true;
}

void PagedStore::Internals::Remove(const std::vector<PageCache::Frame>& evicted)
{
  for (const PageCache::Frame& frame : evicted)
  {
    this->Faults->Remove(frame.From->GetAddress(frame.Id), frame.Footprint);
  }
}

std::size_t PagedStore::Internals::CountNeighbours(const Segment& segment, BlockId id) const
{
  const std::uint64_t begin = segment.Layout.GetOffset(id);
  const std::uint64_t end = begin + segment.Layout.GetFootprint(id);
  std::size_t count = 0;
  BlockId neighbour = 0;
  if (begin > 0 && segment.Layout.Find(begin - 1, neighbour))
  {
    count += segment.Lines[neighbour].State == PageState::Cached ? 1 : 0;
  }
  if (segment.Layout.Find(end, neighbour))
  {
    count += segment.Lines[neighbour].State == PageState::Cached ? 1 : 0;
  }
  return count;
}

void PagedStore::Internals::MarkCached(const Segment& segment, BlockId id)
{
  this->Runs = this->Runs + 1 - this->CountNeighbours(segment, id);
  PageLine& line = segment.Lines[id];
  line.MoveTo(PageState::Cached);
  if (line.IsPrefetched)
  {
    this->Prefetches.CountArrival();
  }
  if (!segment.IsPure)
  {
    segment.SetHint(id, line.IsPrefetched ? PageHint::Prefetched : PageHint::Recent);
  }
}

void PagedStore::Internals::MarkEvicted(const PageCache::Frame& frame)
{
  PageLine& line = frame.From->Lines[frame.Id];
  line.MoveTo(PageState::Absent);
  line.IsPrefetched = false;
  this->Prefetches.CountLosses(frame.WasUnused ? 1 : 0);
  this->Runs = this->Runs + this->CountNeighbours(*frame.From, frame.Id) - 1;
}

BlockRequests::Callbacks PagedStore::Internals::MakeCallbacks()
{
  BlockRequests::Callbacks callbacks;
  callbacks.Find = [this](std::uint32_t number) { return this->Segments.Find(number); };
  callbacks.GetOwned = [](const BlockWant& block) -> const std::byte*
  { return GetSegment(block).GetAddress(block.Id); };
  callbacks.Take = [this](const BlockWant& block, const std::byte* bytes)
  { this->Take(block, bytes); };
  return callbacks;
}

void PagedStore::Internals::Take(const BlockWant& block, const std::byte* bytes)
{
  const Segment& segment = GetSegment(block);
  this->Faults->Place(
    segment.GetAddress(block.Id), bytes, segment.GetDirectory().GetBytes(block.Id));

  const std::lock_guard<std::mutex> lock(this->Guard);
  try
  {
    this->Cache.Insert({ &segment, block.Id, GetFootprint(block), Clock::now() });
  }
  catch (...)
  {
    this->Faults->Remove(segment.GetAddress(block.Id), GetFootprint(block));
    throw;
  }
  this->MarkCached(segment, block.Id);
  this->Workers.WakeThoseThatWaitFor(GetLine(block));
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

void PagedStore::Internals::AbandonRequests()
{
  for (const BlockWant& want : this->Wanted)
  {
    GetLine(want).MoveTo(PageState::Absent);
  }
  this->Wanted.clear();
  this->AbandonForeseen();
  for (const BlockWant& want : this->Requests.Abandon())
  {
    this->Cache.Release(GetFootprint(want));
    GetLine(want).MoveTo(PageState::Absent);
  }
}

void PagedStore::Internals::AbandonForeseen()
{
  for (const BlockWant& want : this->Foreseen)
  {
    PageLine& line = GetLine(want);
    if (line.State == PageState::Foreseen)
    {
      line.MoveTo(PageState::Absent);
      line.IsPrefetched = false;
    }
  }
  this->Foreseen.clear();
  this->UpdateQueuedCount();
}

void PagedStore::Internals::CloseEntrance()
{
  this->IsEntranceOpen.store(false, std::memory_order_release);
  for (const auto& segment : this->Segments)
  {
    segment->Admit(false);
  }
}

void PagedStore::Internals::Cancel(const std::string& cause)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase != FramePhase::Open)
  {
    return; // the first cause stands
  }
  this->Phase = FramePhase::Cancelled;
  this->Cause = cause;
  this->CloseEntrance();
  this->AbandonRequests();
  this->Workers.WakeAll();
  for (const Stopped& stopped : this->Waiting)
  {
    this->TakeCancelled(stopped.Fault, *stopped.From, stopped.Id);
  }
  this->Waiting.clear();
  this->HasClosed.notify_all();
}

bool PagedStore::Internals::Drain()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->AbandonForeseen();
  return this->Phase != FramePhase::Open || this->Requests.GetPendingCount() == 0;
}

void PagedStore::Internals::EndFrame()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase == FramePhase::Closed)
  {
    return;
  }
  this->Requests.EndFrame();
  this->Phase = FramePhase::Closed;
  this->CloseEntrance();
  this->HasClosed.notify_all();
  this->ListenersFailure = nullptr;
  this->Workers.EndFrame();
  this->AbandonRequests();
  this->Frame.PrefetchesUsed = this->Prefetches.EndFrame(
    [](const BlockWant& block)
    {
      PageLine& line = GetLine(block);
      const bool isUnused = std::exchange(line.IsPrefetched, false) &&
        line.State == PageState::Cached &&
        GetSegment(block).GetHint(block.Id) == PageHint::Prefetched;
      if (isUnused)
      {
        GetSegment(block).SetHint(block.Id, PageHint::Idle);
      }
      return isUnused;
    });
  this->Workers.WakeAll();
  if (!this->Faults)
  {
    return;
  }
  this->Faults->Close();
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
  for (const auto& segment : this->Segments)
  {
    for (BlockId id = 0; id < segment->GetDirectory().GetCount(); ++id)
    {
      if (segment->Lines[id].State == PageState::Zeroed)
      {
        this->Faults->RemoveZeros(segment->GetAddress(id), segment->Layout.GetFootprint(id));
        segment->Lines[id].MoveTo(PageState::Absent);
      }
    }
  }
}

// -- Counters --------------------------------------------------------------------------------------

std::vector<WorkerCounters> PagedStore::Internals::GetWorkerCounters()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->Workers.GetCounters(this->IsInFrame());
}

std::uint64_t PagedStore::Internals::GetMisses(const Worker& worker) const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return worker.Slow.Misses;
}

StoreCounters PagedStore::Internals::GetCounters()
{
  const auto workers = this->GetWorkerCounters();
  const std::lock_guard<std::mutex> lock(this->Guard);
  StoreCounters counters = this->Frame;
  counters.Requests = this->Requests.GetCount();
  counters.BytesSent = this->Requests.GetBytesSent();
  counters.BytesReceived = this->Requests.GetBytesReceived();
  counters.Workers = this->Strangers;
  for (const WorkerCounters& worker : workers)
  {
    counters.Workers += worker;
  }
  for (const auto& segment : this->Segments)
  {
    counters.ResidentBytes += segment->GetResidentBytes();
  }
  counters.CachedBytes = this->Cache.GetUsed();
  counters.PeakCachedBytes = this->Cache.GetPeak();
  counters.CacheCapacity = this->Cache.GetCapacity();
  return counters;
}

} // namespace dsm
