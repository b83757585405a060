// SPDX-License-Identifier: BSD-3-Clause
// What workers do: they miss blocks, and foresee them.
#include "DSMCore/fetch/BlockFetcher.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/base/NanosecondsSince.h"

#include <chrono>
#include <exception>
#include <new>
#include <utility>

namespace dsm
{

namespace
{

/// When the system has had so many blocks without having been told of them, it has read the others, too.
constexpr std::size_t ManyFoundUntold = 16;

/// Whether the system was told of a block that nobody has wanted yet.
bool IsForeseenBySystem(const LineStatus& line)
{
  return line.State == LineState::Foreseen &&
    line.Use.load(std::memory_order_relaxed) != BlockUse::Prefetched;
}

} // namespace

bool BlockFetcher::Want(const BlockWant& block)
{
  LineStatus& line = this->GetLine(block);
  const bool isNew = line.State == LineState::Absent || line.State == LineState::Foreseen;
  bool joins = !isNew;
  if (isNew)
  {
    joins = IsForeseenBySystem(line);
    this->SystemUsed += joins ? 1 : 0;
    (this->IsOwned(block) ? this->WantedOwn : this->Wanted).push_back(block);
    line.MoveTo(LineState::Wanted);
    this->UpdateQueuedCount();
  }
  if (line.Use.load(std::memory_order_relaxed) == BlockUse::Prefetched)
  {
    line.Use.store(BlockUse::Idle, std::memory_order_relaxed);
    if (!isNew)
    {
      this->Prefetches.CountJoin();
    }
  }
  return joins;
}

bool BlockFetcher::ReadAtOnce(
  FetchWorker& worker, const BlockWant& block, std::unique_lock<std::mutex>& lock)
{
  LineStatus& line = this->GetLine(block);
  const BlockSource* const source = this->FindSourceForWorkers(block);
  const bool isFree = line.State == LineState::Absent || line.State == LineState::Foreseen;
  if (!source || !isFree || !this->TakeRoom(block))
  {
    return false;
  }
  const auto start = std::chrono::steady_clock::now();
  const bool joins = IsForeseenBySystem(line);
  line.MoveTo(LineState::Pending);
  if (line.Use.load(std::memory_order_relaxed) == BlockUse::Prefetched)
  {
    line.Use.store(BlockUse::Idle, std::memory_order_relaxed);
  }
  lock.unlock();
  BlockMemory memory;
  bool isRead = false;
  try
  {
    const std::size_t bytes = block.From->GetDirectory().GetBytes(block.Id);
    memory = AllocateBlock(bytes);
    isRead = source->ReadWithoutWaiting(block.Id, memory.get(), bytes);
  }
  catch (const std::bad_alloc&) // told by who reads it next, unless there is memory then
  {
  }
  lock.lock();
  try
  {
    this->PrepareToShow();
  }
  catch (const std::bad_alloc&)
  {
    isRead = false;
  }
  if (!joins)
  {
    this->FoundUntold = isRead ? this->FoundUntold + 1 : 0;
  }
  if (!isRead || this->Phase != FramePhase::Open)
  {
    this->GiveRoomBack(block);
    line.MoveTo(LineState::Absent);
    if (joins && this->Phase == FramePhase::Open)
    {
      line.MoveTo(LineState::Foreseen); // as before, for who counts it
    }
    return false;
  }
  this->Show(block, memory);
  ++worker.Slow.Misses;
  worker.Slow.Joins += joins ? 1 : 0;
  this->SystemUsed += joins ? 1 : 0;
  worker.Slow.WaitNanoseconds += NanosecondsSince(start);
  if (line.Waiters > 0)
  {
    this->Workers.WakeThoseThatWaitFor(line);
  }
  if (this->Requests.HasDebts() && !this->MayHaveDebtsHere.exchange(true))
  {
    this->Messages.WakeUp();
  }
  return true;
}

void BlockFetcher::WaitFor(FetchWorker& worker, const BlockWant& block,
  std::unique_lock<std::mutex>& lock, WorkerSlots* slots, bool keeps)
{
  const auto start = std::chrono::steady_clock::now();
  LineStatus& line = this->GetLine(block);
  ++worker.Slow.Misses;
  worker.Slow.Joins += this->Want(block) ? 1 : 0;
  ++line.Waiters;
  worker.WaitsFor = &line;
  const auto leave = [&]
  {
    worker.WaitsFor = nullptr;
    --line.Waiters;
  };
  this->Messages.WakeUp();
  WaitWithoutSlot(
    slots, lock, worker.Woken,
    [&] { return line.State == LineState::Cached || this->Phase != FramePhase::Open; },
    [&]
    {
      if (!keeps)
      {
        leave();
      }
    });
  if (keeps)
  {
    leave();
  }
  worker.Slow.WaitNanoseconds += NanosecondsSince(start);
}

void BlockFetcher::Refuse(const BlockSegment& segment) const
{
  if (this->Phase == FramePhase::Cancelled)
  {
    throw Error(this->Cause);
  }
  throw Error(this->Segments.Has(segment)
      ? "A block of another rank was read outside of a frame. This is a defect of the tracer."
      : "A block of a retired segment was read. This is a defect of the tracer.");
}

void BlockFetcher::ForeseeBySystem(const BlockSegment& segment, const BlockId* ids,
  std::size_t count, std::vector<BlockId>& forSystem)
{
  for (const BlockId* id = ids; id != ids + count; ++id)
  {
    const BlockWant block{ &segment, *id };
    if (*id < segment.GetDirectory().GetCount() && this->GetLine(block).State == LineState::Absent)
    {
      this->TryForeseeBySystem(block, forSystem);
    }
  }
}

bool BlockFetcher::TryForeseeBySystem(const BlockWant& block, std::vector<BlockId>& forSystem)
{
  const BlockSource* const source = this->FindSourceForWorkers(block);
  if (!source || !source->MayForesee())
  {
    return false;
  }
  forSystem.push_back(block.Id);
  this->ForeseenBySystem.push_back(block);
  this->GetLine(block).MoveTo(LineState::Foreseen);
  return true;
}

bool BlockFetcher::Foresee(const BlockSegment& segment, const BlockId* ids, std::size_t count,
  std::vector<BlockId>& forSystem)
{
  const auto isUnused = [this](const BlockWant& block) { return this->IsUnused(block); };
  bool any = false;
  for (const BlockId* id = ids; id != ids + count; ++id)
  {
    const BlockWant block{ &segment, *id };
    if (*id >= segment.GetDirectory().GetCount() || this->GetLine(block).State != LineState::Absent)
    {
      continue;
    }
    if (this->TryForeseeBySystem(block, forSystem))
    {
      continue;
    }
    LineStatus& line = this->GetLine(block);
    if (!this->Prefetches.TryAdd(block, this->GetFootprint(block), isUnused))
    {
      break;
    }
    this->Foreseen.push_back(block);
    line.MoveTo(LineState::Foreseen);
    line.Use.store(BlockUse::Prefetched, std::memory_order_relaxed);
    any = true;
  }
  this->UpdateQueuedCount();
  return any;
}

void BlockFetcher::Prefetch(const BlockSegment& segment, const BlockId* ids, std::size_t count)
{
  bool any = false;
  std::vector<BlockId> forSystem;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    any = this->IsOpenFor(segment) && this->MayPrefetch() &&
      this->Foresee(segment, ids, count, forSystem);
  }
  if (any)
  {
    this->Messages.WakeUp();
  }
  this->Tell(segment, std::move(forSystem));
}

void BlockFetcher::TellSystem(const BlockSegment& segment, const BlockId* ids, std::size_t count,
  FunctionRef<void(BlockId, std::vector<BlockId>&)> around)
{
  std::vector<BlockId> forSystem;
  const auto foresee = [&](const BlockId* some, std::size_t number)
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    if (this->FoundUntold < ManyFoundUntold && this->IsOpenFor(segment) && this->MayPrefetch())
    {
      this->ForeseeBySystem(segment, some, number, forSystem);
    }
  };
  foresee(ids, count);
  std::vector<BlockId> neighbours;
  for (const BlockId id : forSystem)
  {
    around(id, neighbours);
  }
  if (!neighbours.empty())
  {
    foresee(neighbours.data(), neighbours.size());
  }
  this->Tell(segment, std::move(forSystem));
}

void BlockFetcher::Tell(const BlockSegment& segment, std::vector<BlockId> ids) const
{
  if (ids.empty())
  {
    return;
  }
  try
  {
    this->FindSourceForWorkers({ &segment, ids.front() })->Foresee(std::move(ids));
  }
  catch (const std::exception&) // they are read when they are wanted
  {
  }
}

} // namespace dsm
