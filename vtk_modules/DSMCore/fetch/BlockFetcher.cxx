// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/fetch/BlockFetcher.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <new>
#include <utility>

namespace dsm
{

namespace
{

/// Limit of pending reads, above which no reads begin for blocks that no worker waits for.
constexpr std::size_t MostReadsAhead = 256;

} // namespace

BlockFetcher::BlockFetcher(Messenger& messenger)
  : Messages(messenger)
  , Requests(messenger, this->MakeCallbacks())
{
}

// -- Between frames --------------------------------------------------------------------------------

void BlockFetcher::PrepareToAdd(std::size_t count)
{
  if (this->IsInFrame())
  {
    throw Error("Blocks cannot be published during a frame.");
  }
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Segments.MakeRoom(count);
}

void BlockFetcher::Add(std::shared_ptr<BlockSegment> segment)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Expected.NoteAdded(*segment);
  this->Segments.Add(std::move(segment));
}

std::shared_ptr<BlockSegment> BlockFetcher::Retire(const BlockSegment& segment)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (!this->Segments.Has(segment))
  {
    return nullptr;
  }
  if (this->Phase != FramePhase::Closed)
  {
    throw Error("A segment cannot be retired during a frame.");
  }
  this->Expected.NoteRetired(segment, [&] { return this->ListCached(segment); });
  this->Forget(segment);
  return this->Segments.Remove(segment);
}

void BlockFetcher::Refresh(const BlockSegment& segment, const std::vector<bool>& which)
{
  if (this->IsInFrame())
  {
    throw Error("Blocks cannot change during a frame.");
  }
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    const auto kept =
      this->Expected.NoteChanged(segment, which, [&] { return this->ListCached(segment); });
    for (const BlockId id : kept)
    {
      const BlockWant block{ &segment, id };
      BlockSource* const source = this->IsOwned(block) ? this->FindSource(block) : nullptr;
      if (source)
      {
        source->NoteKept(block);
      }
    }
    this->Forget(segment, which);
  }
  this->EndService(); // their memory goes
}

std::size_t BlockFetcher::GetRoomForOwn() const
{
  std::size_t room = 0;
  for (const auto& segment : this->Segments)
  {
    const BlockDirectory& directory = segment->GetDirectory();
    room =
      std::max(room, directory.IsFromSource() ? this->CountFootprint(directory.GetLargest()) : 0);
  }
  return this->Messages.GetSize() > 1 ? room : 0; // a single rank waits for no other
}

bool BlockFetcher::IsAnyPaired() const
{
  return std::any_of(this->Segments.begin(), this->Segments.end(),
    [](const auto& segment) { return segment->GetDirectory().IsPaired(); });
}

void BlockFetcher::CheckCache(std::size_t cacheBytes, std::size_t largest) const
{
  const bool isPair = this->IsAnyPaired();
  const std::size_t footprint = (isPair ? 2 : 1) * this->CountFootprint(largest);
  const std::size_t own = this->GetRoomForOwn();
  if (largest > 0 && cacheBytes < footprint + own)
  {
    throw Error("The cache of " + std::to_string(cacheBytes) + " bytes is smaller than " +
      (isPair ? "two bricks" : "one brick") + " (" + std::to_string(footprint) + " bytes)" +
      (own > 0 ? " plus one brick that the rank owns (" + std::to_string(own) + " bytes)" : "") +
      ". Raise the cache size (DSMCacheSize).");
  }
}

// -- The frame, on the communication thread --------------------------------------------------------

bool BlockFetcher::MayBeginFrame() const
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

void BlockFetcher::BeginFrame(bool agreed)
{
  if (!agreed)
  {
    this->Messages.RunTogether("Cannot begin the frame",
      [this]
      {
        if (this->Phase != FramePhase::Closed)
        {
          throw Error("The previous frame of the store was not ended.");
        }
        this->CheckBudget();
      });
  }
  this->Requests.BeginFrame();

  const std::lock_guard<std::mutex> lock(this->Guard);
  this->FrameCounters = StoreCounters{};
  this->AdvisedUsed = 0;
  this->Workers.BeginFrame();
  this->Phase = FramePhase::Open;
  this->Opened();
  // The ranks have agreed already that the frame begins: nothing may fail any more.
  this->Expected.BeginFrame(
    [this](const BlockSegment& segment, const std::vector<BlockId>& ids)
    {
      try
      {
        if (this->MayPrefetch())
        {
          std::vector<BlockId> advised;
          this->QueuePrefetches(segment, ids.data(), ids.size(), advised);
          this->Advise(segment, std::move(advised));
        }
      }
      catch (const std::bad_alloc&) // wanted blocks will be requested one by one
      {
      }
    });
}

bool BlockFetcher::Service()
{
  bool came = this->Requests.AnswerLater();
  if (this->MayHaveDebtsHere.exchange(false))
  {
    this->Requests.AnswerDebts();
    came = true;
  }
  came = (!this->Busy.empty() && this->PollSources()) || came;
  if (this->QueuedCount.load(std::memory_order_acquire) == 0 && !this->NeedsService())
  {
    return came;
  }
  bool any = came;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    any = this->BeginService() || any;
    if (this->AskForWanted(this->WantedOwn) && this->AskForWanted(this->Wanted))
    {
      this->AskForPrefetches();
    }
    this->UpdateQueuedCount();
  }
  this->EndService();
  return this->SubmitReads() || any;
}

bool BlockFetcher::AskForWanted(std::deque<BlockWant>& wanted)
{
  while (!wanted.empty() && this->TryAsk(wanted.front()))
  {
    wanted.pop_front();
  }
  return wanted.empty();
}

void BlockFetcher::AskForPrefetches()
{
  while (!this->PrefetchQueue.empty() && this->Reads.size() < MostReadsAhead)
  {
    const BlockWant& block = this->PrefetchQueue.front();
    if (this->GetLine(block).State == LineState::Foreseen)
    {
      if (!this->TryAsk(block))
      {
        return;
      }
      ++this->FrameCounters.Prefetches;
    }
    this->PrefetchQueue.pop_front();
  }
}

bool BlockFetcher::TryAsk(const BlockWant& block)
{
  const bool isOwned = this->IsOwned(block);
  const std::size_t others = isOwned ? 0 : this->GetFootprint(block);
  if (others > this->RoomForOthers - this->BytesOfOthers || !this->MakeRoom(block))
  {
    return false;
  }
  const Read read{ block, isOwned ? this->FindSource(block) : &this->Requests };
  const std::size_t before = this->Reads.size();
  try
  {
    this->Reads.push_back(read);
    if (isOwned && std::find(this->Busy.begin(), this->Busy.end(), read.From) == this->Busy.end())
    {
      this->Busy.push_back(read.From);
    }
    read.From->Begin(block);
  }
  catch (...)
  {
    this->Reads.erase(this->Reads.begin() + static_cast<std::ptrdiff_t>(before), this->Reads.end());
    this->GiveRoomBack(block);
    throw;
  }
  this->BytesOfOthers += others;
  this->GetLine(block).MoveTo(LineState::Pending);
  return true;
}

bool BlockFetcher::PollSources()
{
  bool any = false;
  for (BlockSource* const source : this->Busy)
  {
    any = source->Poll(
            [this](const BlockWant& block, BlockMemory memory)
            {
              const std::byte* const bytes = memory.get();
              this->Arrive(block, bytes, std::move(memory));
            }) ||
      any;
  }
  const auto isIdle = [this](const BlockSource* source)
  {
    return std::none_of(this->Reads.begin(), this->Reads.end(),
      [&](const Read& read) { return read.From == source; });
  };
  this->Busy.erase(std::remove_if(this->Busy.begin(), this->Busy.end(), isIdle), this->Busy.end());
  return any;
}

bool BlockFetcher::SubmitReads()
{
  bool any = this->Requests.Submit();
  for (BlockSource* const source : this->Busy)
  {
    any = source->Submit() || any;
  }
  return any;
}

void BlockFetcher::UpdateQueuedCount()
{
  this->QueuedCount.store(this->WantedOwn.size() + this->Wanted.size() + this->PrefetchQueue.size(),
    std::memory_order_release);
}

BlockRequests::Callbacks BlockFetcher::MakeCallbacks()
{
  BlockRequests::Callbacks callbacks;
  callbacks.Find = [this](std::uint32_t number) { return this->Segments.Find(number); };
  callbacks.FindOwned = [this](const BlockWant& block) { return this->FindOwned(block); };
  callbacks.Bring = [this](const BlockWant& block)
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    this->Want(block);
    // A worker may have read it since it was looked for.
    if (this->GetLine(block).State == LineState::Cached)
    {
      this->MayHaveDebtsHere = true;
    }
  };
  callbacks.Take = [this](const BlockWant& block, const std::byte* bytes)
  { this->Arrive(block, bytes, {}); };
  return callbacks;
}

void BlockFetcher::Arrive(const BlockWant& block, const std::byte* bytes, BlockMemory memory)
{
  const auto read = std::find_if(this->Reads.begin(), this->Reads.end(),
    [&](const Read& other) { return other.Block == block; });
  if (read == this->Reads.end())
  {
    throw Error("A block source delivered block " + std::to_string(block.Id) +
      ", which was not requested. This is a bug in the program.");
  }
  // If this throws, the read is abandoned with the frame.
  this->Land(block, bytes, memory);
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    const LineStatus& line = this->GetLine(block);
    this->PrepareToShow();
    this->Show(block, memory);
    if (line.Use.load(std::memory_order_relaxed) == BlockUse::Prefetched)
    {
      this->Prefetches.CountArrival();
    }
    this->Workers.WakeThoseThatWaitFor(line);
  }
  this->BytesOfOthers -= this->IsOwned(block) ? 0 : this->GetFootprint(block);
  this->Reads.erase(read);
  this->Requests.Answer(block, bytes);
}

void BlockFetcher::Cancel(std::string cause)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase != FramePhase::Open)
  {
    return; // the first cause stands
  }
  this->Phase = FramePhase::Cancelled;
  this->Cause = std::move(cause);
  this->Closing();
  this->AbandonAll();
  this->Workers.WakeAll();
  this->Closed();
}

bool BlockFetcher::Drain()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->AbandonPrefetches();
  const bool isThrough = this->Phase != FramePhase::Open || this->Reads.empty();
  if (isThrough)
  {
    this->SettlePrefetches();
  }
  return isThrough;
}

void BlockFetcher::EndFrame()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  if (this->Phase == FramePhase::Closed)
  {
    return;
  }
  this->Requests.EndFrame();
  this->Phase = FramePhase::Closed;
  this->Closing();
  this->Workers.EndFrame();
  this->AbandonAll();
  this->SettlePrefetches();
  this->Workers.WakeAll();
  this->Closed();
}

void BlockFetcher::AbandonAll()
{
  for (std::deque<BlockWant>* const wanted : { &this->WantedOwn, &this->Wanted })
  {
    for (const BlockWant& block : *wanted)
    {
      this->GetLine(block).MoveTo(LineState::Absent);
    }
    wanted->clear();
  }
  this->AbandonPrefetches();
  this->Requests.Abandon();
  for (BlockSource* const source : this->Busy)
  {
    source->Abandon();
  }
  this->Busy.clear();
  for (const Read& read : this->Reads)
  {
    this->GiveRoomBack(read.Block);
    this->GetLine(read.Block).MoveTo(LineState::Absent);
  }
  this->Reads.clear();
  this->BytesOfOthers = 0;
}

/// Finds out how many were used. No worker may use any behind it; again does nothing.
void BlockFetcher::SettlePrefetches()
{
  this->FrameCounters.PrefetchesUsed = this->Prefetches.EndFrame(
                                         [this](const BlockWant& block)
                                         {
                                           const bool isUnused = this->Settle(block);
                                           if (isUnused)
                                           {
                                             this->Expected.NoteUnused(block);
                                           }
                                           return isUnused;
                                         }) +
    this->AdvisedUsed;
}

void BlockFetcher::AbandonPrefetches()
{
  const auto abandon = [this](const BlockWant& block)
  {
    LineStatus& line = this->GetLine(block);
    if (line.State == LineState::Foreseen)
    {
      line.MoveTo(LineState::Absent);
      line.Use.store(BlockUse::Idle, std::memory_order_relaxed);
    }
  };
  std::for_each(this->PrefetchQueue.begin(), this->PrefetchQueue.end(), abandon);
  this->PrefetchQueue.clear();
  std::for_each(this->Advised.begin(), this->Advised.end(), abandon);
  this->Advised.clear();
  this->UpdateQueuedCount();
}

// -- Counters --------------------------------------------------------------------------------------

void BlockFetcher::CountEvictions(std::size_t count, std::size_t unused)
{
  this->FrameCounters.Evictions += count;
  this->Prefetches.CountLosses(unused);
}

std::vector<WorkerCounters> BlockFetcher::GetWorkerCounters()
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->Workers.GetCounters(this->IsInFrame());
}

std::uint64_t BlockFetcher::GetMisses(const FetchWorker& worker) const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return worker.Slow.Misses;
}

StoreCounters BlockFetcher::GetCounters()
{
  const auto workers = this->GetWorkerCounters();
  const std::lock_guard<std::mutex> lock(this->Guard);
  StoreCounters counters = this->FrameCounters;
  counters.Prefetches += this->AdvisedUsed;
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
  }
  this->AddCounters(counters);
  return counters;
}

} // namespace dsm
