// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/ObjectStore.h"

#include "DSMCore/FragmentExchange.h"
#include "DSMCore/HostMemory.h"
#include "DSMCore/ObjectStoreInternals.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace dsm
{

namespace
{

/// Equal directories have equal ones (FNV-1a).
std::uint64_t GetFingerprint(const BlockDirectory& directory)
{
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (BlockId id = 0; id < directory.GetCount(); ++id)
  {
    hash = (hash ^ directory.GetBytes(id)) * 0x100000001b3u;
    hash = (hash ^ static_cast<std::uint64_t>(directory.GetOwner(id))) * 0x100000001b3u;
  }
  return hash;
}

/// Blocks are dealt evenly, so the other ranks of the host want as much as this one.
void CheckHostMemory(std::uint64_t bytes, int ranksOnHost, std::uint64_t available)
{
  if (bytes > available / static_cast<std::uint64_t>(ranksOnHost))
  {
    throw Error("out of memory: " + std::to_string(bytes >> 20) + " MiB are needed for each of " +
      std::to_string(ranksOnHost) + " ranks on the host, which has " +
      std::to_string(available >> 20) +
      " MiB left. Use more hosts, so that each holds fewer bytes, or smaller data.");
  }
}

} // namespace

// -- Segment ---------------------------------------------------------------------------------------

ObjectStore::Segment::Segment(std::uint32_t number, BlockDirectory directory, int rank)
  : BlockSegment(number, std::move(directory))
  , Lines(new BlockLine[this->GetDirectory().GetCount()])
  , Arena(this->GetDirectory().GetResidentBytes(rank))
  , ResidentBytes(this->GetDirectory().GetResidentBytes(rank))
  , Rank(rank)
{
  std::size_t offset = 0;
  for (BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
  {
    BlockLine& line = this->Lines[id];
    line.Bytes = this->GetDirectory().GetBytes(id);
    if (this->GetDirectory().GetOwner(id) == rank)
    {
      line.MoveTo(LineState::Owned);
      line.Referenced.store(1, std::memory_order_relaxed);
      line.Address.store(this->Arena.GetData() + offset, std::memory_order_release);
      offset += AlignBlock(line.Bytes);
    }
  }
}

std::byte* ObjectStore::Segment::GetOwned(BlockId id) const
{
  const std::byte* const address = this->Lines[id].Address.load(std::memory_order_relaxed);
  return this->Arena.GetData() + (address - this->Arena.GetData());
}

void ObjectStore::Segment::ForEachResident(const Visit& visit) const
{
  for (BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
  {
    if (this->GetDirectory().GetOwner(id) == this->Rank)
    {
      visit(id, this->GetOwned(id), this->Lines[id].Bytes);
    }
  }
}

// -- Store -----------------------------------------------------------------------------------------

ObjectStore::ObjectStore(Messenger& messenger, const Settings& settings)
  : Self(std::make_unique<Internals>(*this, messenger, settings))
{
}

ObjectStore::~ObjectStore()
{
  this->Self->EndFrame();
}

void ObjectStore::SetSettings(const Settings& settings)
{
  this->Self->Configure(settings);
}

const ObjectStore::Settings& ObjectStore::GetSettings() const
{
  return this->Self->Current;
}

std::shared_ptr<BlockSegment> ObjectStore::Publish(const std::string& what,
  BlockDirectory directory, FragmentSource& source, FragmentSink& sink,
  const std::function<void(double)>& progress)
{
  Messenger& messages = this->Self->Messages;
  // Stores that share a messenger draw from one sequence, so the number names the segment among all
  // of theirs.
  const std::uint32_t number = messages.BeginSession();
  const int ranksOnHost = messages.GetRanksOnHost();
  // Asked before the ranks meet in the next line, hence before any of them takes memory.
  const std::uint64_t available = GetAvailableHostMemory();
  const auto fingerprints = messages.AllGatherValue(GetFingerprint(directory));
  std::shared_ptr<Segment> segment;
  messages.RunTogether(what,
    [&]
    {
      if (this->Self->IsInFrame())
      {
        throw Error("Blocks cannot be published within a frame.");
      }
      if (std::count(fingerprints.begin(), fingerprints.end(), fingerprints.front()) !=
        messages.GetSize())
      {
        throw Error("The ranks disagree about the number, the sizes or the owners of the blocks. "
                    "Do all ranks see the same extent of the data?");
      }
      for (BlockId id = 0; id < directory.GetCount(); ++id)
      {
        if (directory.GetOwner(id) < 0 || directory.GetOwner(id) >= messages.GetSize())
        {
          throw Error("Block " + std::to_string(id) + " was assigned to rank " +
            std::to_string(directory.GetOwner(id)) + ", but there are " +
            std::to_string(messages.GetSize()) + " ranks.");
        }
      }
      CheckHostMemory(directory.GetResidentBytes(messages.GetRank()), ranksOnHost, available);
      segment = std::make_shared<Segment>(number, std::move(directory), messages.GetRank());
      segment->ForEachResident([&](BlockId id, const std::byte*, std::size_t bytes)
        { sink.Begin(id, segment->GetOwned(id), bytes); });
    });

  messages.BeginSession();
  std::string cause;
  {
    FragmentExchange exchange(
      messages, segment->GetDirectory(), [&segment](BlockId id) { return segment->GetOwned(id); });
    cause = exchange.Run(source, sink, progress);
  }

  messages.RunTogether(what,
    [&]
    {
      if (!cause.empty())
      {
        throw Error(cause);
      }
      segment->ForEachResident([&](BlockId id, const std::byte*, std::size_t bytes)
        { sink.Finish(id, segment->GetOwned(id), bytes); });
      if (progress)
      {
        progress(1.0);
      }
    });
  this->Self->Add(segment);
  return segment;
}

void ObjectStore::Retire(const std::shared_ptr<BlockSegment>& segment)
{
  if (segment)
  {
    this->Self->Retire(*segment);
  }
}

void ObjectStore::BeginFrame()
{
  this->Self->BeginFrame();
}

bool ObjectStore::Service()
{
  return this->Self->Service();
}

void ObjectStore::Cancel(const std::string& cause)
{
  this->Self->Cancel(cause);
}

void ObjectStore::EndFrame()
{
  this->Self->EndFrame();
}

ObjectStore::Worker& ObjectStore::GetWorker(int index)
{
  return *this->Self->Workers.at(static_cast<std::size_t>(index));
}

const std::byte* ObjectStore::Wait(Worker& worker, const Segment& segment, BlockId id)
{
  return this->Self->Wait(worker, segment, id);
}

void ObjectStore::Announce(Worker& worker)
{
  if (worker.Pins != 0)
  {
    throw Error("A worker announced a quiescent point while it held a block. This is a defect of "
                "the tracer.");
  }
  if (worker.Epoch.load(std::memory_order_relaxed) != Worker::Offline)
  {
    worker.Epoch.store(this->Epoch.load(std::memory_order_acquire), std::memory_order_release);
    this->Self->Messages.WakeUp(); // memory may have come free
  }
}

void ObjectStore::Enter(Worker& worker)
{
  this->Self->Enter(worker);
}

void ObjectStore::Leave(Worker& worker)
{
  this->Self->Leave(worker);
}

StoreCounters ObjectStore::GetCounters() const
{
  return this->Self->GetCounters();
}

std::vector<WorkerCounters> ObjectStore::GetWorkerCounters() const
{
  return this->Self->GetWorkerCounters();
}

} // namespace dsm
