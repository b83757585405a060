// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/store/BlockStore.h"

#include "DSMCore/base/ByteDigest.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/fetch/ReadingSource.h"
#include "DSMCore/memory/AddressRange.h"
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/publish/FragmentStream.h"
#include "DSMCore/publish/SegmentUpdate.h"
#include "DSMCore/store/ScratchBlocks.h"
#include "DSMCore/store/StoreInterface.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace dsm
{

template class StoreInterface<ObjectStore>;
template class StoreInterface<PagedStore>;
template class StoreInterface<ReplicatedStore>;

namespace
{

/// The memory that a host has left is divided by it for the blocks of its ranks when the user says
/// nothing: the rest is for the application.
constexpr std::uint64_t DefaultDivisor = 2;

/// The default limit is at least this, so that a host whose memory is nearly used up shows small data.
constexpr std::uint64_t LeastDefaultBytes = std::uint64_t(64) << 20;

/// The time that it takes to put blocks together in a scratch file, as a part of all.
constexpr double ShareOfFilling = 0.6;

/// Puts fragments into blocks as another sink does, and counts their bytes.
class CountingSink final : public FragmentSink
{
public:
  CountingSink(FragmentSink& sink, std::uint64_t& bytes)
    : Sink(sink)
    , Bytes(bytes)
  {
  }
  void Begin(BlockId id, std::byte* block, std::size_t bytes) override
  {
    this->Sink.Begin(id, block, bytes);
  }
  void Absorb(BlockId id, std::byte* block, std::size_t bytes, const std::byte* fragment,
    std::size_t fragmentBytes) override
  {
    this->Sink.Absorb(id, block, bytes, fragment, fragmentBytes);
    this->Bytes += fragmentBytes;
  }
  void Finish(BlockId id, std::byte* block, std::size_t bytes) override
  {
    this->Sink.Finish(id, block, bytes);
  }

private:
  FragmentSink& Sink;
  std::uint64_t& Bytes;
};

bool IsPaged(MemoryOrganization organization)
{
  return organization == MemoryOrganization::PageBased;
}

} // namespace

BlockStore::BlockStore(Messenger& messenger, const Settings& settings)
  : Messages(messenger)
  , Objects(messenger, ObjectStore::Settings{})
  , Replicated(messenger, ReplicatedStore::Settings{})
{
  this->SetSettings(settings);
}

BlockStore::~BlockStore() = default;

void BlockStore::SetSettings(const Settings& settings)
{
  const Settings& old = this->Current;
  if (!this->Segments.IsEmpty() && IsPaged(settings.Organization) != IsPaged(this->InForce))
  {
    throw Error(
      "The memory organization cannot change to or from page based while data are published.");
  }
  if (settings.Organization != old.Organization || settings.MemoryBytes != old.MemoryBytes ||
    settings.CacheBytes != old.CacheBytes || settings.SourceCacheBytes != old.SourceCacheBytes ||
    this->Explanation.empty())
  {
    this->Settled = false;
  }
  const Settings previous = this->Current;
  this->Current = settings;
  try
  {
    if (IsPaged(settings.Organization) && !this->Paged)
    {
      this->Paged = std::make_unique<PagedStore>(this->Messages, PagedStore::Settings{});
    }
    this->Configure();
  }
  catch (...)
  {
    this->Current = previous;
    throw;
  }
  if (this->Segments.IsEmpty())
  {
    this->InForce = settings.Organization == MemoryOrganization::Automatic
      ? MemoryOrganization::Replicated
      : settings.Organization;
  }
}

int BlockStore::CountWorkers() const
{
  if (this->Current.Overlap < 1)
  {
    throw Error("The number of workers per tracing thread must be at least 1.");
  }
  const bool waits = this->Messages.GetSize() > 1 || this->IsAnyFromSource();
  return this->Current.Workers * (waits ? this->Current.Overlap : 1);
}

bool BlockStore::IsAnyFromSource() const
{
  return std::any_of(this->Segments.begin(), this->Segments.end(),
    [](const auto& segment) { return segment->GetDirectory().IsFromSource(); });
}

void BlockStore::Configure()
{
  ObjectStore::Settings objects;
  objects.CacheBytes = static_cast<std::size_t>(std::min<std::uint64_t>(
    this->Room.CacheBytes, this->IsAnyFromSource() ? SIZE_MAX : this->Current.CacheBytes));
  objects.ReplyBytes = static_cast<std::size_t>(this->Room.ReplyBytes);
  objects.Workers = this->CountWorkers();
  objects.Slots = this->Slots;
  objects.Prefetch = this->Current.Prefetch;
  objects.HostSharing = this->Current.HostSharing;
  objects.Groups = this->Groups;
  ReplicatedStore::Settings replicated;
  replicated.Workers = this->Current.Workers;
  replicated.HostSharing = this->Current.HostSharing;
  replicated.Groups = this->Groups;
  if (this->Paged)
  {
    PagedStore::Settings paged;
    paged.CacheBytes = objects.CacheBytes;
    paged.ReplyBytes = objects.ReplyBytes;
    paged.Workers = objects.Workers;
    paged.Slots = this->Slots;
    paged.Prefetch = this->Current.Prefetch;
    paged.PureFaulting = this->Current.PureFaulting;
    this->Paged->SetSettings(paged);
  }
  this->Objects.SetSettings(objects);
  this->Replicated.SetSettings(replicated);
}

// -- Plans -----------------------------------------------------------------------------------------

void BlockStore::FindBudget()
{
  if (this->Current.MemoryBytes != 0)
  {
    this->Budget = { this->Current.MemoryBytes, this->Current.MemoryBytes };
    return;
  }
  // Asked once: what is published would count against itself.
  if (this->AvailableBytes == 0)
  {
    this->AvailableBytes = std::max<std::uint64_t>(
      GetAvailableHostMemory() / static_cast<std::uint64_t>(this->Messages.GetRanksOnHost()), 1);
  }
  this->Budget = { std::max(this->AvailableBytes / DefaultDivisor, LeastDefaultBytes),
    std::max(this->AvailableBytes, LeastDefaultBytes) };
}

BlockStore::Decision BlockStore::Decide(
  std::string_view what, const BlockDirectory* next, Decision& fallback)
{
  this->Messages.GetRanksOnHost(); // collective the first time
  this->Groups = HostGroups::Find(this->Messages, this->Current.HostSharing);
  Stance mine{ {}, static_cast<std::uint64_t>(this->Current.Organization), 0 };
  this->Messages.RunTogether(what,
    [&]
    {
      this->FindBudget();
      this->Configure();
      this->Segments.MakeRoom(1);
      this->Objects.MakeRoom(this->Segments.GetCount() + 1);
      this->Replicated.MakeRoom(this->Segments.GetCount() + 1);
      mine.LacksHostMemory = this->LacksHostMemory(next) ? 1 : 0;
    });
  mine.Budget = this->Budget;
  const std::uint64_t parts[] = { this->Segments.GetCount(), next ? next->GetFingerprint() : 0,
    next != nullptr, this->Current.HostSharing, static_cast<std::uint64_t>(this->InForce),
    this->Current.ScratchDirectory.empty() };
  mine.Choice = HashBytes(parts, sizeof(parts));
  const auto stances = this->Messages.AllGatherValue(mine);
  Decision decision;
  std::string shortage;
  this->Messages.RunTogether(what,
    [&]
    {
      const MemoryOrganization wanted = this->Current.Organization;
      const MemoryPlan plan = this->MakePlan(stances, next);
      const auto decide = [&](MemoryOrganization chosen)
      {
        return Decision{ chosen, plan.GetRoom(chosen, this->Messages.GetRank()),
          plan.Explain(wanted, chosen), plan.LacksMemory(wanted, chosen) };
      };
      try
      {
        decision = decide(plan.Decide(wanted));
        fallback = decide(MemoryOrganization::ObjectBased);
      }
      catch (const MemoryShortage& lack) // on every rank alike
      {
        shortage = lack.what();
      }
      for (std::size_t rank = 0; rank < stances.size() && shortage.empty(); ++rank)
      {
        shortage = stances[rank].LacksHostMemory != 0
          ? "The host of rank " + std::to_string(rank) + " is out of memory."
          : "";
      }
    });
  if (!shortage.empty())
  {
    throw MemoryShortage(std::string(what) + ": " + shortage);
  }
  return decision;
}

bool BlockStore::LacksHostMemory(const BlockDirectory* next) const
{
  if (!next || next->IsFromSource() || this->Current.ScratchDirectory.empty())
  {
    return false;
  }
  const int rank = this->Messages.GetRank();
  const std::uint64_t bytes = next->GetResidentBytes(rank) +
    (this->Current.Organization == MemoryOrganization::Replicated
        ? BlockTable::CountReplicaBytes(*next, *this->Groups, rank)
        : 0);
  return bytes >
    GetAvailableHostMemory() / static_cast<std::uint64_t>(this->Messages.GetRanksOnHost());
}

MemoryPlan BlockStore::MakePlan(
  const std::vector<Stance>& stances, const BlockDirectory* next) const
{
  std::vector<MemoryPlan::Budget> budgets;
  for (std::size_t rank = 0; rank < stances.size(); ++rank)
  {
    if (stances[rank].Choice != stances.front().Choice)
    {
      throw Error("Rank " + std::to_string(rank) +
        " and rank 0 disagree on the blocks or the memory settings. Do all ranks have the same "
        "extent of the data and the same settings?");
    }
    budgets.push_back(stances[rank].Budget);
  }
  std::vector<const BlockDirectory*> directories;
  for (const auto& segment : this->Segments)
  {
    directories.push_back(&segment->GetDirectory());
  }
  if (next)
  {
    directories.push_back(next);
  }
  return MemoryPlan(std::move(directories), *this->Groups, std::move(budgets),
    AddressRange::GetPageBytes(), this->Current.SourceCacheBytes);
}

void BlockStore::PutInForce(Decision&& decision)
{
  this->Explanation = std::move(decision.Explanation);
  this->IsShort = decision.IsShort;
  this->Room = decision.Room;
  this->ReadByAll =
    this->IsAnyFromSource() && this->Current.Organization == MemoryOrganization::Replicated;
  for (const auto& segment : this->Segments)
  {
    if (segment->GetDirectory().IsFromSource() && !IsPaged(this->InForce))
    {
      static_cast<BlockTable&>(*segment).SetReadByAll(
        this->ReadByAll && !segment->GetDirectory().IsOnOwnersDisk());
    }
  }
  this->Messages.Insist([this] { this->Configure(); });
  this->Settled = true;
}

void BlockStore::Settle()
{
  Decision fallback;
  Decision decision = this->Decide("Cannot apply the memory settings", nullptr, fallback);
  this->MoveTo(decision, std::move(fallback));
  this->PutInForce(std::move(decision));
}

void BlockStore::MoveTo(Decision& decision, Decision&& fallback)
{
  if (IsPaged(decision.Chosen) || IsPaged(this->InForce))
  {
    this->InForce = decision.Chosen; // nothing is published: see SetSettings
    return;
  }
  if (decision.Chosen != MemoryOrganization::Replicated)
  {
    this->GiveUpCopies();
    return;
  }
  try
  {
    this->Replicate();
    this->InForce = MemoryOrganization::Replicated;
  }
  catch (const Error&) // on every rank alike
  {
    if (this->Current.Organization != MemoryOrganization::Automatic)
    {
      throw;
    }
    decision = std::move(fallback);
  }
}

void BlockStore::Replicate()
{
  for (const auto& segment : this->Segments)
  {
    const auto table = std::static_pointer_cast<BlockTable>(segment);
    if (table->IsReplicated())
    {
      continue;
    }
    this->Objects.Surrender(*table);
    try
    {
      this->Replicated.Adopt(table);
    }
    catch (...)
    {
      this->Objects.Adopt(table);
      this->GiveUpCopies();
      throw;
    }
  }
}

void BlockStore::GiveUpCopies()
{
  for (const auto& segment : this->Segments)
  {
    const auto table = std::static_pointer_cast<BlockTable>(segment);
    if (table->IsReplicated())
    {
      this->Replicated.Surrender(*table);
      this->Objects.Adopt(table);
    }
  }
  this->InForce = MemoryOrganization::ObjectBased;
}

// -- Segments --------------------------------------------------------------------------------------

std::shared_ptr<BlockSegment> BlockStore::Publish(std::string_view what, BlockDirectory directory,
  FragmentSource& source, FragmentSink& toFill, FunctionRef<void(double)> progress, Place place)
{
  CountingSink sink(toFill, this->BytesPublished);
  if (place == Place::Scratch)
  {
    return this->PublishToScratch(what, std::move(directory), source, sink, progress);
  }
  Decision fallback;
  Decision decision = this->Decide(what, &directory, fallback);
  const auto publish = [&](auto& store)
  { return store.Publish(what, std::move(directory), source, sink, progress); };
  std::shared_ptr<BlockSegment> segment;
  // If Automatic wants to replicate the data, they are published object based first. Then nothing
  // is lost if there is no memory for the copies.
  if (this->Current.Organization == MemoryOrganization::Automatic &&
    decision.Chosen == MemoryOrganization::Replicated)
  {
    segment = publish(this->Objects);
    this->Segments.Add(segment);
    this->MoveTo(decision, std::move(fallback));
  }
  else
  {
    this->MoveTo(decision, std::move(fallback));
    segment = this->Visit(publish);
    this->Segments.Add(segment);
  }
  this->PutInForce(std::move(decision));
  ++this->Publications;
  return segment;
}

std::shared_ptr<BlockSegment> BlockStore::Publish(
  std::string_view what, BlockDirectory directory, std::shared_ptr<BlockSource> source)
{
  directory.SetFromSource();
  Decision fallback;
  Decision decision = this->Decide(what, &directory, fallback);
  this->MoveTo(decision, std::move(fallback));
  const auto segment = IsPaged(this->InForce)
    ? this->Paged->Publish(what, std::move(directory), std::move(source))
    : this->Objects.Publish(what, std::move(directory), std::move(source));
  this->Segments.Add(segment);
  this->PutInForce(std::move(decision));
  ++this->Publications;
  return segment;
}

std::shared_ptr<BlockSegment> BlockStore::PublishToScratch(std::string_view what,
  BlockDirectory&& directory, FragmentSource& source, FragmentSink& sink,
  FunctionRef<void(double)> progress)
{
  const int ranks = this->Messages.GetSize();
  std::shared_ptr<ScratchBlocks> blocks;
  std::shared_ptr<ReadingSource> reading;
  this->Messages.RunTogether(what,
    [&]
    {
      directory.SetOnOwnersDisk();
      static_assert(ScratchBlocks::MostInMemory <= ReadingSource::MostReads,
        "what is set aside for blocks that are read suffices before, too");
      directory.AddIndexBytes(ReadingSource::MostReads * directory.GetLargest() +
        ScratchBlocks::CountTableBytes(directory, ranks));
      blocks = std::make_shared<ScratchBlocks>(directory, this->Messages.GetRank(), ranks);
      reading = std::make_shared<ReadingSource>(
        this->Messages, blocks, "the scratch file in '" + this->Current.ScratchDirectory + "'");
    });
  // First of all, so that caches have left what it takes.
  const auto segment = this->Publish(what, std::move(directory), std::move(reading));
  try
  {
    this->Messages.RunTogether(what, [&] { blocks->Open(this->Current.ScratchDirectory); });
    const auto absorb = [&](BlockId id, const std::byte* bytes, std::size_t count)
    { blocks->Absorb(id, bytes, count, sink); };
    using Progress = FunctionRef<void(double)>;
    const auto ofFilling = [&](double done) { progress(ShareOfFilling * done); };
    const auto ofFinishing = [&](double done)
    { progress(ShareOfFilling + (1.0 - ShareOfFilling) * done); };
    const FirstFailure failure = FragmentStream::Run(this->Messages, segment->GetDirectory(),
      source, absorb, progress ? Progress(ofFilling) : Progress());
    this->Messages.RunTogether(what,
      [&]
      {
        failure.Throw();
        blocks->Finish(sink, progress ? Progress(ofFinishing) : Progress());
        if (progress)
        {
          progress(1.0);
        }
      });
  }
  catch (...)
  {
    this->Retire(segment);
    throw;
  }
  return segment;
}

bool BlockStore::MayUpdate(const std::shared_ptr<BlockSegment>& segment) const
{
  return segment && this->Settled && this->Segments.Has(*segment) &&
    !segment->GetDirectory().IsFromSource();
}

void BlockStore::Update(std::string_view what, const std::shared_ptr<BlockSegment>& segment,
  const std::vector<bool>& chosen, FragmentSource& source, FragmentSink& toFill,
  FunctionRef<void(double)> progress)
{
  CountingSink sink(toFill, this->BytesPublished);
  segment->CountUpdate(); // first: what fails is not what it was, either
  const std::vector<bool> changed =
    SegmentUpdate::Run(this->Messages, what, *segment, chosen, source, sink, progress);
  this->Visit([&](auto& store) { store.Refresh(what, *segment, changed); });
  ++this->Publications;
}

bool BlockStore::MayRefresh(const std::shared_ptr<BlockSegment>& segment) const
{
  return segment && this->Settled && this->Segments.Has(*segment) &&
    segment->GetDirectory().IsFromSource() && !segment->GetDirectory().IsOnOwnersDisk();
}

void BlockStore::Refresh(std::string_view what, const std::shared_ptr<BlockSegment>& segment,
  const std::vector<bool>& changed)
{
  segment->CountUpdate(); // first, as with Update
  this->Visit([&](auto& store) { store.Refresh(what, *segment, changed); });
  ++this->Publications;
}

void BlockStore::Retire(const std::shared_ptr<BlockSegment>& segment)
{
  if (segment && this->Segments.Remove(*segment))
  {
    this->Visit([&](auto& store) { store.Retire(segment); });
    this->Settled = false; // there is more room
  }
}

// -- Counters --------------------------------------------------------------------------------------

StoreCounters BlockStore::GetCounters()
{
  StoreCounters counters = this->Visit([](auto& store) { return store.GetCounters(); });
  const bool anyReadThrough = std::any_of(this->Segments.begin(), this->Segments.end(),
    [](const auto& segment) { return segment->GetDirectory().IsReadThroughCache(); });
  counters.TableBytes += anyReadThrough ? this->Current.SourceCacheBytes : 0;
  counters.MemoryBudget = this->Budget.Bytes;
  counters.Publications = this->Publications;
  counters.BytesPublished = this->BytesPublished;
  return counters;
}

std::uint64_t BlockStore::GetBytesFrom(int owner)
{
  return this->Visit([=](auto& store) { return store.GetBytesFrom(owner); });
}

std::vector<WorkerCounters> BlockStore::GetWorkerCounters()
{
  const auto all = this->Visit([](auto& store) { return store.GetWorkerCounters(); });
  std::vector<WorkerCounters> counters(static_cast<std::size_t>(this->Current.Workers));
  for (std::size_t worker = 0; worker < all.size(); ++worker)
  {
    counters[worker % counters.size()] += all[worker];
  }
  return counters;
}

} // namespace dsm
