// SPDX-License-Identifier: BSD-3-Clause
// Functions of workers: they miss blocks, and prefetch them.
#include "DSMCore/fetch/BlockFetcher.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/base/NanosecondsSince.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iterator>
#include <new>
#include <utility>

namespace dsm
{

namespace
{

/// Cutting a brick out of a file takes a thread's time, also in vain: where workers cannot read it by themselves, only
/// the first part of those that are foreseen is worth it, divided by this.
constexpr std::size_t PartOfCut = 2;

bool IsCutFromFile(const BlockDirectory& directory)
{
  return directory.IsFromSource() && !directory.IsOnOwnersDisk();
}

/// Returns whether the system was advised of a block that no worker has wanted yet.
bool IsAdvised(const LineStatus& line)
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
    joins = IsAdvised(line);
    this->AdvisedUsed += joins ? 1 : 0;
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
  const bool joins = IsAdvised(line);
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
  this->AdvisedUsed += joins ? 1 : 0;
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

void BlockFetcher::WaitFor(FetchWorker& worker, std::initializer_list<BlockWant> blocks,
  std::unique_lock<std::mutex>& lock, WorkerSlots* slots, bool keeps)
{
  const auto start = std::chrono::steady_clock::now();
  const LineStatus** next = worker.WaitsFor;
  for (const BlockWant& block : blocks)
  {
    LineStatus& line = this->GetLine(block);
    if (!line.IsHere())
    {
      ++worker.Slow.Misses;
      worker.Slow.Joins += this->Want(block) ? 1 : 0;
    }
    ++line.Waiters;
    *next++ = &line;
  }
  const auto areHere = [&]
  {
    return std::all_of(blocks.begin(), blocks.end(),
      [this](const BlockWant& block) { return this->GetLine(block).IsHere(); });
  };
  const auto leave = [&]
  {
    std::fill(std::begin(worker.WaitsFor), std::end(worker.WaitsFor), nullptr);
    for (const BlockWant& block : blocks)
    {
      --this->GetLine(block).Waiters;
    }
  };
  this->Messages.WakeUp();
  WaitWithoutSlot(
    slots, lock, worker.Woken, [&] { return this->Phase != FramePhase::Open || areHere(); },
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
      ? "A block owned by another rank was read outside a frame. This is a bug in the tracer."
      : "A block of a retired segment was read. This is a bug in the tracer.");
}

bool BlockFetcher::TryAdvise(const BlockWant& block, std::vector<BlockId>& advised)
{
  const BlockSource* const source = this->FindSourceForWorkers(block);
  if (!source || !source->MayPrefetch())
  {
    return false;
  }
  advised.push_back(block.Id);
  this->Advised.push_back(block);
  this->GetLine(block).MoveTo(LineState::Foreseen);
  return true;
}

bool BlockFetcher::QueuePrefetches(
  const BlockSegment& segment, const BlockId* ids, std::size_t count, std::vector<BlockId>& advised)
{
  const BlockDirectory& directory = segment.GetDirectory();
  const std::size_t most = IsCutFromFile(directory) ? (count + PartOfCut - 1) / PartOfCut : count;
  const auto isUnused = [this](const BlockWant& block) { return this->IsUnused(block); };
  const std::size_t before = this->PrefetchQueue.size();
  for (std::size_t index = 0; index < count; ++index)
  {
    const BlockWant block{ &segment, ids[index] };
    if (block.Id >= directory.GetCount() || this->GetLine(block).State != LineState::Absent ||
      this->TryAdvise(block, advised) || index >= most)
    {
      continue;
    }
    if (!this->Prefetches.TryAdd(block, this->GetFootprint(block), isUnused))
    {
      break;
    }
    this->PrefetchQueue.push_back(block);
    LineStatus& line = this->GetLine(block);
    line.MoveTo(LineState::Foreseen);
    line.Use.store(BlockUse::Prefetched, std::memory_order_relaxed);
  }
  this->UpdateQueuedCount();
  return this->PrefetchQueue.size() != before;
}

void BlockFetcher::Prefetch(const BlockSegment& segment, const BlockId* ids, std::size_t count,
  FunctionRef<void(BlockId, std::vector<BlockId>&)> addNeighbors)
{
  std::vector<BlockId> advised;
  const auto mayPrefetch = [&] { return this->IsOpenFor(segment) && this->MayPrefetch(); };
  bool anyQueued = false;
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    anyQueued = mayPrefetch() && this->QueuePrefetches(segment, ids, count, advised);
  }
  if (anyQueued)
  {
    this->Messages.WakeUp();
  }
  if (addNeighbors && IsCutFromFile(segment.GetDirectory()))
  {
    std::vector<BlockId> neighbors;
    for (const BlockId id : advised)
    {
      addNeighbors(id, neighbors);
    }
    const std::lock_guard<std::mutex> lock(this->Guard);
    for (const BlockId id : neighbors)
    {
      const BlockWant block{ &segment, id };
      if (mayPrefetch() && id < segment.GetDirectory().GetCount() &&
        this->GetLine(block).State == LineState::Absent)
      {
        this->TryAdvise(block, advised);
      }
    }
  }
  this->Advise(segment, std::move(advised));
}

void BlockFetcher::Advise(const BlockSegment& segment, std::vector<BlockId> ids) const
{
  if (ids.empty())
  {
    return;
  }
  try
  {
    this->FindSourceForWorkers({ &segment, ids.front() })->Prefetch(std::move(ids));
  }
  catch (const std::exception&) // they are read when they are wanted
  {
  }
}

} // namespace dsm
