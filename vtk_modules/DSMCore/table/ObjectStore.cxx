// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/ObjectStore.h"

#include "DSMCore/publish/SegmentPublisher.h"
#include "DSMCore/table/ObjectStoreInternals.h"

#include <algorithm>
#include <string>
#include <utility>

namespace dsm
{

ObjectStore::ObjectStore(Messenger& messenger, const Settings& settings)
  : Self(std::make_unique<Internals>(*this, messenger, settings))
{
  this->Fetcher = this->Self.get();
}

ObjectStore::~ObjectStore() = default;

void ObjectStore::SetSettings(const Settings& settings)
{
  this->Self->Configure(settings);
}

const ObjectStore::Settings& ObjectStore::GetSettings() const
{
  return this->Self->Current;
}

std::shared_ptr<BlockSegment> ObjectStore::Publish(std::string_view what, BlockDirectory directory,
  FragmentSource& source, FragmentSink& sink, FunctionRef<void(double)> progress)
{
  Messenger& messages = this->Self->Messages;
  const Settings& settings = this->GetSettings();
  const auto groups =
    settings.Groups ? settings.Groups : HostGroups::Find(messages, settings.HostSharing);
  const auto count = [&](const BlockDirectory& blocks)
  {
    this->Self->PrepareToAdd();
    return blocks.GetResidentBytes(messages.GetRank());
  };
  const auto create = [&](std::uint32_t number, BlockDirectory&& blocks)
  { return std::make_shared<BlockTable>(number, std::move(blocks), messages.GetRank(), *groups); };
  const auto table =
    std::static_pointer_cast<BlockTable>(SegmentPublisher(messages, what, { count, create })
                                           .Run(std::move(directory), source, sink, progress));
  this->Self->Add(table);
  return table;
}

std::shared_ptr<BlockSegment> ObjectStore::Publish(
  std::string_view what, BlockDirectory directory, std::shared_ptr<BlockSource> source)
{
  Messenger& messages = this->Self->Messages;
  directory.SetFromSource();
  const auto count = [this](const BlockDirectory&)
  {
    this->Self->PrepareToAdd();
    return std::uint64_t(0);
  };
  const auto create = [&](std::uint32_t number, BlockDirectory&& blocks)
  {
    return std::make_shared<BlockTable>(
      number, std::move(blocks), messages.GetRank(), messages.GetSize(), std::move(source));
  };
  const auto table =
    SegmentPublisher(messages, what, { count, create }).Create(std::move(directory));
  this->Self->Add(table);
  return table;
}

void ObjectStore::Retire(const std::shared_ptr<BlockSegment>& segment)
{
  if (segment)
  {
    this->Self->Retire(*segment);
  }
}

void ObjectStore::MakeRoom(std::size_t count)
{
  this->Self->PrepareToAdd(count);
}

void ObjectStore::Adopt(std::shared_ptr<BlockTable> table)
{
  this->Self->Add(std::move(table));
}

void ObjectStore::Surrender(const BlockTable& table)
{
  this->Self->Retire(table);
}

ObjectStore::Worker& ObjectStore::GetWorker(int index)
{
  return static_cast<Worker&>(this->Self->Workers.Get(index));
}

const std::byte* ObjectStore::Wait(Worker& worker, const Segment& segment, BlockId id)
{
  return this->Self->Wait(worker, segment, id);
}

std::array<const std::byte*, 2> ObjectStore::WaitForPair(
  Worker& worker, const Segment& segment, BlockId id, const Segment& otherSegment, BlockId otherId)
{
  return this->Self->WaitForPair(worker, { &segment, id }, { &otherSegment, otherId });
}

bool ObjectStore::Prefetch(const BlockSegment& segment, const BlockId* ids, std::size_t count,
  FunctionRef<void(BlockId, std::vector<BlockId>&)> addNeighbors)
{
  const bool isAnyAbsent = static_cast<const Segment&>(segment).IsAnyAbsent(ids, count);
  if (isAnyAbsent)
  {
    this->Self->Prefetch(segment, ids, count, addNeighbors);
  }
  return isAnyAbsent;
}

void ObjectStore::Announce(Worker& worker)
{
  if (worker.Pins != 0)
  {
    throw Error(
      "A worker announced a quiescent point while it held a block. This is a bug in the tracer.");
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

} // namespace dsm
