// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/BlockTable.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/publish/BlockSpread.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace dsm
{

namespace
{

/// Offset of each rank's next block in memory where the rank's blocks are contiguous, in ascending
/// order of id.
class Offsets
{
public:
  explicit Offsets(int ranks)
    : Next(static_cast<std::size_t>(ranks), 0)
  {
  }
  std::uint64_t Take(int rank, std::uint32_t bytes)
  {
    std::uint64_t& next = this->Next[static_cast<std::size_t>(rank)];
    const std::uint64_t offset = next;
    next += AlignBlock(bytes);
    return offset;
  }

private:
  std::vector<std::uint64_t> Next;
};

} // namespace

BlockTable::BlockTable(std::uint32_t number, BlockDirectory directory, int rank, HostGroups groups)
  : BlockSegment(number, std::move(directory))
  , Lines(new BlockLine[this->GetDirectory().GetCount()])
  , Groups(std::move(groups))
  , Rank(rank)
  , Resident(this->GetDirectory().GetResidentBytes(rank), this->Groups.GetMembers(rank).size() > 1)
  , Views(static_cast<std::size_t>(this->Groups.GetRankCount()))
  , CopyViews(static_cast<std::size_t>(this->Groups.GetRankCount()))
  , ResidentBytes(this->GetDirectory().GetResidentBytes(rank))
{
  this->Missing = this->GetDirectory().GetCount();
  std::size_t offset = 0;
  for (BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
  {
    BlockLine& line = this->Lines[id];
    line.Bytes = this->GetDirectory().GetBytes(id);
    if (this->GetDirectory().GetOwner(id) == rank)
    {
      this->Place(id, LineState::Owned, this->Resident.GetData() + offset);
      offset += AlignBlock(line.Bytes);
    }
  }
}

BlockTable::BlockTable(std::uint32_t number, BlockDirectory directory, int rank, int ranks,
  std::shared_ptr<BlockSource> source)
  : BlockSegment(number, std::move(directory))
  , Lines(new BlockLine[this->GetDirectory().GetCount()])
  , Groups(HostGroups::Separate(ranks))
  , Rank(rank)
  , Source(std::move(source))
  , Views(static_cast<std::size_t>(ranks))
  , CopyViews(static_cast<std::size_t>(ranks))
  , Missing(this->GetDirectory().GetCount())
{
  for (BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
  {
    this->Lines[id].Bytes = this->GetDirectory().GetBytes(id);
  }
}

void BlockTable::Place(BlockId id, LineState state, const std::byte* address)
{
  BlockLine& line = this->Lines[id];
  line.MoveTo(state);
  line.Use.store(BlockUse::Recent, std::memory_order_relaxed);
  line.Address.store(address, std::memory_order_release);
  --this->Missing;
}

std::byte* BlockTable::GetOwned(BlockId id) const
{
  std::byte* const first = this->Resident.GetData();
  return first + (this->Lines[id].Address.load(std::memory_order_relaxed) - first);
}

void BlockTable::ForEachResident(const Visit& visit) const
{
  if (this->Source)
  {
    this->Source->ForEach(this->GetDirectory(), this->Rank, visit);
    return;
  }
  for (BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
  {
    if (this->Lines[id].State == LineState::Owned)
    {
      visit(id, this->GetOwned(id), this->Lines[id].Bytes);
    }
  }
}

void BlockTable::OpenAll(Messenger& messenger, const HostSharedMemory& own,
  std::vector<HostSharedMemory::View>& views) const
{
  const auto tickets = messenger.AllGatherValue(own.GetTicket());
  for (const int mate : this->Groups.GetMembers(this->Rank))
  {
    if (mate != this->Rank)
    {
      if (auto view = HostSharedMemory::Open(tickets[static_cast<std::size_t>(mate)]))
      {
        views[static_cast<std::size_t>(mate)] = std::move(*view);
      }
    }
  }
}

void BlockTable::Meet(Messenger& messenger)
{
  this->OpenAll(messenger, this->Resident, this->Views);
}

void BlockTable::Seal()
{
  Offsets offsets(this->Groups.GetRankCount());
  const BlockDirectory& directory = this->GetDirectory();
  for (BlockId id = 0; id < directory.GetCount(); ++id)
  {
    const int owner = directory.GetOwner(id);
    const std::uint64_t offset = offsets.Take(owner, directory.GetBytes(id));
    const std::byte* const data = this->Views[static_cast<std::size_t>(owner)].GetData();
    if (data && owner != this->Rank)
    {
      this->Place(id, LineState::Shared, data + offset);
      this->SharedBytes += AlignBlock(directory.GetBytes(id));
    }
  }
}

void BlockTable::Open()
{
  this->Resident.CloseDoor();
}

std::uint64_t BlockTable::CountReplicaBytes(
  const BlockDirectory& directory, const HostGroups& groups, int rank)
{
  std::uint64_t bytes = 0;
  for (BlockId id = 0; id < directory.GetCount(); ++id)
  {
    const int owner = directory.GetOwner(id);
    if (owner != rank && groups.GetHolder(id, owner, groups.GetGroup(rank)) == rank)
    {
      bytes += AlignBlock(directory.GetBytes(id));
    }
  }
  return bytes;
}

void BlockTable::Replicate(Messenger& messenger, std::string_view what)
{
  const BlockDirectory& directory = this->GetDirectory();
  const int group = this->Groups.GetGroup(this->Rank);
  HostSharedMemory copies;
  std::uint64_t bytes = 0;
  std::vector<std::uint64_t> places; // offset of each block in its holder's copies
  messenger.RunTogether(what,
    [&]
    {
      bytes = CountReplicaBytes(directory, this->Groups, this->Rank);
      copies = HostSharedMemory(bytes, this->Groups.GetMembers(this->Rank).size() > 1);
      places.assign(directory.GetCount(), 0);
      Offsets offsets(messenger.GetSize());
      for (BlockId id = 0; id < directory.GetCount(); ++id)
      {
        const int owner = directory.GetOwner(id);
        const int holder = this->Groups.GetHolder(id, owner, group);
        places[id] = holder == owner ? 0 : offsets.Take(holder, directory.GetBytes(id));
      }
    });

  const auto find = [this](BlockId id) { return this->GetOwned(id); };
  const auto place = [&](BlockId id) { return copies.GetData() + places[id]; };
  const FirstFailure failure = BlockSpread::Run(messenger, directory, this->Groups, find, place);
  this->OpenAll(messenger, copies, this->CopyViews);
  try
  {
    messenger.RunTogether(what,
      [&]
      {
        failure.Throw();
        this->CheckViews();
      });
  }
  catch (...)
  {
    this->DropReplicas();
    throw;
  }
  copies.CloseDoor();
  this->Copies = std::move(copies);
  this->ReplicaBytes = bytes;
  this->Replicated = true;
  for (BlockId id = 0; id < directory.GetCount(); ++id)
  {
    const int holder = this->Groups.GetHolder(id, directory.GetOwner(id), group);
    if (this->Lines[id].State == LineState::Absent)
    {
      const std::byte* const data = holder == this->Rank
        ? this->Copies.GetData()
        : this->CopyViews[static_cast<std::size_t>(holder)].GetData();
      this->Place(id, LineState::Replica, data + places[id]);
      this->SharedCopyBytes += holder == this->Rank ? 0 : AlignBlock(directory.GetBytes(id));
    }
  }
}

void BlockTable::UpdateReplicas(
  Messenger& messenger, std::string_view what, const std::vector<bool>& changed) const
{
  const auto find = [this](BlockId id) { return this->GetOwned(id); };
  // A rank is sent what it holds for its host itself, which is in memory that it may write.
  const auto place = [this](BlockId id)
  { return const_cast<std::byte*>(this->Lines[id].Address.load(std::memory_order_relaxed)); };
  const FirstFailure failure =
    BlockSpread::Run(messenger, this->GetDirectory(), this->Groups, find, place, &changed);
  messenger.RunTogether(what, [&] { failure.Throw(); });
}

void BlockTable::CheckViews() const
{
  for (const int mate : this->Groups.GetMembers(this->Rank))
  {
    const auto index = static_cast<std::size_t>(mate);
    if (mate != this->Rank && !(this->CopyViews[index].GetData() && this->Views[index].GetData()))
    {
      throw Error("Cannot map the memory of rank " + std::to_string(mate) +
        ", which runs on the same host. Turn off host sharing (DSMHostSharing).");
    }
  }
}

void BlockTable::DropReplicas()
{
  for (BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
  {
    BlockLine& line = this->Lines[id];
    if (line.State == LineState::Replica)
    {
      line.MoveTo(LineState::Absent);
      line.Use.store(BlockUse::Idle, std::memory_order_relaxed);
      line.Address.store(nullptr, std::memory_order_relaxed);
      ++this->Missing;
    }
  }
  this->Copies = HostSharedMemory();
  for (HostSharedMemory::View& view : this->CopyViews)
  {
    view = HostSharedMemory::View();
  }
  this->ReplicaBytes = 0;
  this->SharedCopyBytes = 0;
  this->Replicated = false;
}

} // namespace dsm
