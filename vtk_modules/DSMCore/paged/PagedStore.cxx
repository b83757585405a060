// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/PagedStore.h"

#include "DSMCore/paged/PagedStoreInternals.h"
#include "DSMCore/publish/SegmentPublisher.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>
#include <utility>

namespace dsm
{

namespace
{

/// Size of a large page on common processors. A rank's own blocks begin at a multiple of it.
constexpr std::size_t LargePageBytes = std::size_t(2) << 20;

} // namespace

// -- Segment ---------------------------------------------------------------------------------------

PagedStore::Segment::Segment(std::uint32_t number, BlockDirectory directory, int rank, int ranks,
  std::shared_ptr<PageFaults> faults, std::shared_ptr<BlockSource> source)
  : BlockSegment(number, std::move(directory))
  , Layout(this->GetDirectory(), ranks, AddressRange::GetPageBytes())
  , Entries(new std::atomic<std::uintptr_t>[this->GetDirectory().GetCount()])
  , ClosedEntries(this->GetDirectory().GetCount() * sizeof(std::uintptr_t))
  , Lines(new LineStatus[this->GetDirectory().GetCount()])
  , Rank(rank)
  , Source(std::move(source))
  , Handler(std::move(faults))
{
  this->Attached.reserve(2);
  const std::size_t page = AddressRange::GetPageBytes();
  // A page before and behind: see below.
  this->Range = AddressRange(this->Layout.GetBytes() + 2 * page + LargePageBytes);
  const std::uintptr_t begin = reinterpret_cast<std::uintptr_t>(this->Range.GetData()) + page;
  const std::uintptr_t owned = begin + this->GetOwnedBegin();
  this->Base = this->Range.GetData() + page +
    ((owned + LargePageBytes - 1) / LargePageBytes * LargePageBytes - owned);

  // In a frame that was cancelled blocks may read as zeros; a reader whom they mislead by a few
  // bytes beyond its block finds zeros there too.
  std::byte* const end = this->Base + this->Layout.GetBytes();
  std::byte* const mine = this->Base + this->GetOwnedBegin();
  const std::uint64_t bytes = this->GetResidentBytes();
  if (mprotect(this->Base - page, page, PROT_READ) != 0 || mprotect(end, page, PROT_READ) != 0 ||
    (bytes > 0 && mprotect(mine, bytes, PROT_READ | PROT_WRITE) != 0))
  {
    throw std::bad_alloc();
  }
#ifdef MADV_HUGEPAGE
  madvise(mine, bytes, MADV_HUGEPAGE); // a wish: without it all is slower, nothing is wrong
#endif
  if (mprotect(this->ClosedEntries.GetData(), this->ClosedEntries.GetBytes(), PROT_READ) != 0)
  {
    throw std::bad_alloc();
  }
  for (BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
  {
    if (this->IsAlwaysHere(id))
    {
      this->Lines[id].MoveTo(LineState::Owned);
    }
  }
  this->ResetHints(false);
  this->Admit(false);
}

PagedStore::Segment::~Segment()
{
  this->Detach();
}

void PagedStore::Segment::ForEachResident(const Visit& visit) const
{
  if (this->Source)
  {
    this->Source->ForEach(this->GetDirectory(), this->Rank, visit);
    return;
  }
  for (BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
  {
    if (this->IsOwned(id))
    {
      visit(id, this->GetAddress(id), this->GetDirectory().GetBytes(id));
    }
  }
}

std::uint64_t PagedStore::Segment::GetResidentBytes() const
{
  return this->GetOwnedEnd() - this->GetOwnedBegin();
}

PageHint PagedStore::Segment::GetHint(BlockId id) const
{
  return static_cast<PageHint>(this->Entries[id].load(std::memory_order_relaxed) -
    reinterpret_cast<std::uintptr_t>(this->GetAddress(id)));
}

void PagedStore::Segment::SetHint(BlockId id, PageHint hint) const
{
  this->Entries[id].store(
    reinterpret_cast<std::uintptr_t>(this->GetAddress(id)) + static_cast<std::uintptr_t>(hint),
    std::memory_order_relaxed);
}

bool PagedStore::Segment::TryMarkRecent(BlockId id) const
{
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(this->GetAddress(id));
  const auto mark = [&](PageHint from)
  {
    // By exchange, not over the mark of an eviction that happens right now.
    std::uintptr_t expected = address + static_cast<std::uintptr_t>(from);
    return this->Entries[id].compare_exchange_strong(
      expected, address + static_cast<std::uintptr_t>(PageHint::Recent), std::memory_order_relaxed);
  };
  return mark(PageHint::Idle) || mark(PageHint::Prefetched);
}

bool PagedStore::Segment::IsAlwaysHere(BlockId id) const
{
  return this->IsOwned(id) || this->Layout.GetFootprint(id) == 0;
}

void PagedStore::Segment::ResetHints(bool pure)
{
  this->IsPure = pure;
  for (BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
  {
    const bool isHere =
      pure || this->IsAlwaysHere(id) || this->Lines[id].State == LineState::Cached;
    this->SetHint(id, isHere ? PageHint::Recent : PageHint::Absent);
  }
}

void PagedStore::Segment::Admit(bool open)
{
  const auto* const closed =
    reinterpret_cast<const std::atomic<std::uintptr_t>*>(this->ClosedEntries.GetData());
  this->VisibleEntries.store(open ? this->Entries.get() : closed, std::memory_order_release);
}

bool PagedStore::Segment::Contains(const std::byte* address) const
{
  return address >= this->Base && address < this->Base + this->Layout.GetBytes();
}

bool PagedStore::Segment::FindRemote(const std::byte* address, BlockId& id) const
{
  return this->Contains(address) &&
    this->Layout.Find(static_cast<std::uint64_t>(address - this->Base), id) && !this->IsOwned(id);
}

void PagedStore::Segment::Protect(bool writable)
{
  const std::uint64_t begin = this->GetOwnedBegin();
  const std::uint64_t end = this->GetOwnedEnd();
  const int access = writable ? PROT_READ | PROT_WRITE : PROT_READ;
  if (end > begin && mprotect(this->Base + begin, end - begin, access) != 0)
  {
    throw std::bad_alloc();
  }
}

void PagedStore::Segment::Seal()
{
  const std::uint64_t begin = this->GetOwnedBegin();
  const std::uint64_t end = this->GetOwnedEnd();
  this->Protect(false);
  if (!this->Handler)
  {
    return; // one rank: all is owned
  }
  for (const auto& [first, last] :
    { std::make_pair(std::uint64_t(0), begin), std::make_pair(end, this->Layout.GetBytes()) })
  {
    if (last > first)
    {
      this->Handler->Attach(this->Base + first, last - first);
      this->Attached.push_back(this->Base + first);
    }
  }
}

void PagedStore::Segment::Detach()
{
  for (std::byte* const begin : this->Attached)
  {
    this->Handler->Detach(begin);
  }
  this->Attached.clear();
  this->Handler.reset();
}

// -- Store -----------------------------------------------------------------------------------------

PagedStore::PagedStore(Messenger& messenger, const Settings& settings)
  : Self(std::make_unique<Internals>(messenger, settings))
{
  this->Fetcher = this->Self.get();
}

PagedStore::~PagedStore() = default;

void PagedStore::SetSettings(const Settings& settings)
{
  this->Self->Configure(settings);
}

const PagedStore::Settings& PagedStore::GetSettings() const
{
  return this->Self->Current;
}

std::shared_ptr<BlockSegment> PagedStore::Publish(std::string_view what, BlockDirectory directory,
  FragmentSource& source, FragmentSink& sink, FunctionRef<void(double)> progress)
{
  Messenger& messages = this->Self->Messages;
  const auto count = [&](const BlockDirectory& blocks)
  {
    this->Self->CheckFaults();
    this->Self->PrepareToAdd();
    return blocks.GetResidentBytes(messages.GetRank(), AddressRange::GetPageBytes());
  };
  const auto create = [&](std::uint32_t number, BlockDirectory&& blocks)
  {
    return std::make_shared<Segment>(
      number, std::move(blocks), messages.GetRank(), messages.GetSize(), this->Self->Faults);
  };
  const auto segment =
    std::static_pointer_cast<Segment>(SegmentPublisher(messages, what, { count, create })
                                        .Run(std::move(directory), source, sink, progress));
  this->Self->Add(segment);
  return segment;
}

std::shared_ptr<BlockSegment> PagedStore::Publish(
  std::string_view what, BlockDirectory directory, std::shared_ptr<BlockSource> source)
{
  Messenger& messages = this->Self->Messages;
  directory.SetFromSource();
  const auto count = [&](const BlockDirectory&)
  {
    this->Self->RequireFaults();
    this->Self->PrepareToAdd();
    return std::uint64_t(0);
  };
  const auto create = [&](std::uint32_t number, BlockDirectory&& blocks)
  {
    const auto created = std::make_shared<Segment>(number, std::move(blocks), messages.GetRank(),
      messages.GetSize(), this->Self->Faults, std::move(source));
    created->Seal();
    return created;
  };
  const auto segment =
    SegmentPublisher(messages, what, { count, create }).Create(std::move(directory));
  this->Self->Add(segment);
  return segment;
}

void PagedStore::Retire(const std::shared_ptr<BlockSegment>& segment)
{
  if (const auto retired = segment ? this->Self->Retire(*segment) : nullptr)
  {
    static_cast<Segment&>(*retired).Detach();
  }
}

PagedStore::Worker& PagedStore::GetWorker(int index)
{
  return static_cast<Worker&>(this->Self->Workers.Get(index));
}

PagedStore::Pin PagedStore::Admit(Worker& worker, const Segment& segment, BlockId id)
{
  if (!this->Self->IsEntranceOpen() || !segment.TryMarkRecent(id))
  {
    this->Self->Wait(worker, segment, id);
  }
  return Pin(segment.GetAddress(id), segment, id);
}

bool PagedStore::Prefetch(const BlockSegment& segment, const BlockId* ids, std::size_t count,
  FunctionRef<void(BlockId, std::vector<BlockId>&)> addNeighbors)
{
  const Segment& self = static_cast<const Segment&>(segment);
  // Mostly all is here; then the lock is not taken.
  const bool isAnyAbsent = std::any_of(ids, ids + count,
    [&](BlockId id)
    { return id < self.GetDirectory().GetCount() && self.GetHint(id) == PageHint::Absent; });
  if (isAnyAbsent)
  {
    this->Self->Prefetch(segment, ids, count, addNeighbors);
  }
  return isAnyAbsent;
}

void PagedStore::Enter(Worker& worker)
{
  this->Self->Enter(worker);
}

void PagedStore::Leave(Worker& worker)
{
  this->Self->Leave(worker);
}

} // namespace dsm
