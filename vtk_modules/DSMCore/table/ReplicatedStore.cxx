// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/ReplicatedStore.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/base/WorkerSlots.h"
#include "DSMCore/publish/SegmentPublisher.h"

#include <utility>

namespace dsm
{

ReplicatedStore::ReplicatedStore(Messenger& messenger, const Settings& settings)
  : Messages(messenger)
{
  this->SetSettings(settings);
}

ReplicatedStore::~ReplicatedStore() = default;

void ReplicatedStore::SetSettings(const Settings& settings)
{
  CheckWorkerCount(settings.Workers);
  if (this->InFrame)
  {
    throw Error("The settings of a store cannot change during a frame.");
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
}

// -- Segments --------------------------------------------------------------------------------------

std::shared_ptr<BlockSegment> ReplicatedStore::Publish(std::string_view what,
  BlockDirectory directory, FragmentSource& source, FragmentSink& sink,
  FunctionRef<void(double)> progress)
{
  const int rank = this->Messages.GetRank();
  const auto groups = this->Current.Groups
    ? this->Current.Groups
    : HostGroups::Find(this->Messages, this->Current.HostSharing);
  const auto count = [&](const BlockDirectory& blocks)
  {
    if (this->InFrame)
    {
      throw Error("Blocks cannot be published during a frame.");
    }
    this->Segments.MakeRoom(1);
    return blocks.GetResidentBytes(rank) + BlockTable::CountReplicaBytes(blocks, *groups, rank);
  };
  const auto create = [&](std::uint32_t number, BlockDirectory&& blocks)
  { return std::make_shared<BlockTable>(number, std::move(blocks), rank, *groups); };
  const SegmentPublisher::Steps steps{ count, create,
    "Choose the object based memory organization (DSMMemoryOrganization), which distributes the "
    "data to the ranks, or use smaller data." };
  auto table =
    std::static_pointer_cast<BlockTable>(SegmentPublisher(this->Messages, what, steps)
                                           .Run(std::move(directory), source, sink, progress));
  table->Replicate(this->Messages, what);
  this->Segments.Add(table);
  return table;
}

void ReplicatedStore::Retire(const std::shared_ptr<BlockSegment>& segment)
{
  if (!segment || !this->Segments.Has(*segment))
  {
    return;
  }
  if (this->InFrame)
  {
    throw Error("A segment cannot be retired during a frame.");
  }
  this->Segments.Remove(*segment)->DropReplicas();
}

void ReplicatedStore::Refresh(
  std::string_view what, const BlockSegment& segment, const std::vector<bool>& changed)
{
  static_cast<const BlockTable&>(segment).UpdateReplicas(this->Messages, what, changed);
}

void ReplicatedStore::MakeRoom(std::size_t count)
{
  this->Segments.MakeRoom(count);
}

void ReplicatedStore::Adopt(std::shared_ptr<BlockTable> table)
{
  table->Replicate(this->Messages, "Replicating the data");
  this->Segments.Add(std::move(table));
}

void ReplicatedStore::Surrender(BlockTable& table)
{
  table.DropReplicas();
  this->Segments.Remove(table);
}

// -- The frame -------------------------------------------------------------------------------------

void ReplicatedStore::BeginFrame(bool)
{
  if (this->InFrame)
  {
    throw Error("The previous frame of the store was not ended.");
  }
  for (const auto& worker : this->Workers)
  {
    worker->Accesses.store(0, std::memory_order_relaxed);
  }
  this->InFrame = true;
}

void ReplicatedStore::EndFrame()
{
  this->InFrame = false;
}

ReplicatedStore::Worker& ReplicatedStore::GetWorker(int index)
{
  return *this->Workers.at(static_cast<std::size_t>(index));
}

std::vector<WorkerCounters> ReplicatedStore::GetWorkerCounters() const
{
  std::vector<WorkerCounters> counters;
  for (const auto& worker : this->Workers)
  {
    WorkerCounters counter;
    counter.Accesses = worker->Accesses.load(std::memory_order_relaxed);
    counter.Hits = counter.Accesses;
    counters.push_back(counter);
  }
  return counters;
}

StoreCounters ReplicatedStore::GetCounters() const
{
  StoreCounters counters;
  for (const WorkerCounters& worker : this->GetWorkerCounters())
  {
    counters.Workers += worker;
  }
  for (const auto& segment : this->Segments)
  {
    counters.ResidentBytes += segment->GetResidentBytes();
    counters.ReplicaBytes += segment->GetReplicaBytes();
    counters.SharedBytes += segment->GetSharedBytes();
    counters.TableBytes += BlockTable::CountTableBytes(segment->GetDirectory());
  }
  return counters;
}

} // namespace dsm
