// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/store/MemoryPlan.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/fetch/BlockRequests.h"
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/paged/PagedStore.h"
#include "DSMCore/table/BlockTable.h"

#include <algorithm>
#include <map>
#include <utility>

namespace dsm
{

namespace
{

/// The memory that cache and messages share is divided by it for messages.
constexpr std::uint64_t MessageDivisor = 16;

} // namespace

MemoryPlan::MemoryPlan(std::vector<const BlockDirectory*> segments, const HostGroups& groups,
  std::vector<Budget> budgets, std::size_t page, std::uint64_t sourceCache)
  : Segments(std::move(segments))
  , Budgets(std::move(budgets))
  , OneGroup(groups.GetGroupCount() == 1)
  , AnyFromSource(std::any_of(this->Segments.begin(), this->Segments.end(),
      [](const BlockDirectory* directory) { return directory->IsFromSource(); }))
  , AnyOnOwnersDisk(std::any_of(this->Segments.begin(), this->Segments.end(),
      [](const BlockDirectory* directory) { return directory->IsOnOwnersDisk(); }))
  , Blocks(BlockAlignment)
  , Pages(page)
  , Copies(this->Budgets.size(), 0)
{
  this->Count(this->Blocks);
  this->Count(this->Pages);
  bool anyReadThrough = false;
  for (const BlockDirectory* directory : this->Segments)
  {
    this->Blocks.Tables += BlockTable::CountTableBytes(*directory);
    this->Pages.Tables += PagedStore::Segment::CountTableBytes(*directory);
    anyReadThrough = anyReadThrough || directory->IsReadThroughCache();
  }
  this->Blocks.Tables += anyReadThrough ? sourceCache : 0;
  this->Pages.Tables += anyReadThrough ? sourceCache : 0;
  for (int rank = 0; rank < static_cast<int>(this->Copies.size()); ++rank)
  {
    this->LargestGroup = std::max(this->LargestGroup, groups.GetMembers(rank).size());
  }
  if (!this->AnyFromSource) // else nothing is copied
  {
    this->CountCopies(groups);
  }
}

// -- Numbers ---------------------------------------------------------------------------------------

void MemoryPlan::Count(Sums& sums) const
{
  sums.Resident.assign(this->Budgets.size(), 0);
  for (const BlockDirectory* directory : this->Segments)
  {
    sums.Largest = std::max(sums.Largest, sums.GetFootprint(directory->GetLargest()));
    if (directory->IsFromSource())
    {
      continue; // all of them may be somewhere else
    }
    for (BlockId id = 0; id < directory->GetCount(); ++id)
    {
      const std::uint64_t bytes = sums.GetFootprint(directory->GetBytes(id));
      const auto owner = static_cast<std::size_t>(directory->GetOwner(id));
      sums.Total += bytes;
      // Owners that do not exist are refused when the blocks are published.
      if (owner < sums.Resident.size())
      {
        sums.Resident[owner] += bytes;
      }
    }
  }
}

void MemoryPlan::CountCopies(const HostGroups& groups)
{
  // Once over the blocks, of which there may be a million, not once for each of a thousand ranks: what the members
  // of a group of each size would hold if all blocks were others', without what is the group's own.
  std::map<std::size_t, std::vector<std::uint64_t>> turns;
  for (int rank = 0; rank < groups.GetRankCount(); ++rank)
  {
    const std::size_t size = groups.GetMembers(rank).size();
    turns[size].resize(size, 0);
  }
  for (const BlockDirectory* directory : this->Segments)
  {
    for (BlockId id = 0; id < directory->GetCount(); ++id)
    {
      const std::uint64_t bytes = this->Blocks.GetFootprint(directory->GetBytes(id));
      const int owner = directory->GetOwner(id);
      if (owner < 0 || owner >= groups.GetRankCount())
      {
        continue; // as in Count
      }
      for (auto& [size, sums] : turns)
      {
        sums[groups.GetTurn(id, size)] += bytes;
      }
      const std::vector<int>& members = groups.GetMembers(owner);
      const int instead = members[groups.GetTurn(id, members.size())];
      this->Copies[static_cast<std::size_t>(instead)] -= bytes; // at least as much is added below
    }
  }
  for (int rank = 0; rank < groups.GetRankCount(); ++rank)
  {
    const std::vector<int>& members = groups.GetMembers(rank);
    const auto turn = std::find(members.begin(), members.end(), rank) - members.begin();
    this->Copies[static_cast<std::size_t>(rank)] +=
      turns[members.size()][static_cast<std::size_t>(turn)];
  }
}

std::uint64_t MemoryPlan::GetNeed(MemoryOrganization organization, int rank) const
{
  const Sums& sums = this->GetSums(organization);
  const auto index = static_cast<std::size_t>(rank);
  const bool replicated = organization == MemoryOrganization::Replicated;
  return sums.Resident[index] + sums.Tables +
    (replicated                       ? this->Copies[index]
        : this->Fetches(organization) ? this->GetLeastRoom(sums)
                                      : 0);
}

std::uint64_t MemoryPlan::GetLeastRoom(const Sums& sums) const
{
  const bool alone = this->Budgets.size() == 1; // no rank requests blocks
  return sums.Largest * (alone ? 1 : LeastRoom + (this->AnyFromSource ? 1 : 0));
}

bool MemoryPlan::Fetches(MemoryOrganization organization) const
{
  if (this->AnyFromSource)
  {
    return organization != MemoryOrganization::Replicated;
  }
  switch (organization)
  {
    case MemoryOrganization::Replicated:
      return false;
    case MemoryOrganization::PageBased:
      return this->Budgets.size() > 1;
    default: // nothing is cached that the group has
      return !this->OneGroup;
  }
}

MemoryPlan::Room MemoryPlan::GetRoom(MemoryOrganization organization, int rank) const
{
  const Budget& budget = this->Budgets[static_cast<std::size_t>(rank)];
  const Sums& sums = this->GetSums(organization);
  const std::uint64_t need = this->GetNeed(organization, rank);
  const std::uint64_t all = std::max(budget.Bytes, std::min(need, budget.Limit));
  const std::uint64_t taken = sums.Resident[static_cast<std::size_t>(rank)] + sums.Tables;
  Room room{ all - std::min(all, taken), 0 };
  if (this->Fetches(organization) && this->Budgets.size() > 1)
  {
    room.ReplyBytes = std::max(sums.Largest,
      std::min<std::uint64_t>(room.CacheBytes / MessageDivisor, BlockRequests::MostReplyBytes));
    room.CacheBytes -= std::min(room.CacheBytes, room.ReplyBytes + sums.Largest);
  }
  return room;
}

// -- Decisions -------------------------------------------------------------------------------------

int MemoryPlan::FindPoorest(MemoryOrganization organization) const
{
  int poorest = -1;
  std::uint64_t most = 0;
  for (int rank = 0; rank < static_cast<int>(this->Budgets.size()); ++rank)
  {
    const std::uint64_t need = this->GetNeed(organization, rank);
    const Budget& budget = this->Budgets[static_cast<std::size_t>(rank)];
    const std::uint64_t limit =
      organization == MemoryOrganization::Replicated ? budget.Bytes : budget.Limit;
    if (need > limit && need - limit > most)
    {
      most = need - limit;
      poorest = rank;
    }
  }
  return poorest;
}

int MemoryPlan::FindRankCount(MemoryOrganization organization) const
{
  std::uint64_t least = UINT64_MAX;
  for (const Budget& budget : this->Budgets)
  {
    least = std::min(least, budget.Limit);
  }
  const Sums& sums = this->GetSums(organization);
  const std::uint64_t besides =
    sums.Tables + (LeastRoom + (this->AnyFromSource ? 1 : 0)) * sums.Largest;
  if (least < besides)
  {
    return 0;
  }
  if (sums.Total == 0)
  {
    return 1;
  }
  // No fewer than these would do; from there on, the shares are counted.
  const std::uint64_t room = least - besides;
  std::uint64_t ranks = room > 0 ? (sums.Total + room - 1) / room : MostRanks;
  while (ranks < MostRanks)
  {
    std::vector<std::uint64_t> shares(ranks, 0);
    std::size_t most = 0;
    for (const BlockDirectory* directory : this->Segments)
    {
      if (directory->IsFromSource())
      {
        continue;
      }
      const RoundRobinAssigner assigner(static_cast<int>(ranks));
      most = std::max<std::size_t>(most, directory->GetCount());
      for (BlockId id = 0; id < directory->GetCount(); ++id)
      {
        shares[static_cast<std::size_t>(assigner.GetOwner(id))] +=
          sums.GetFootprint(directory->GetBytes(id));
      }
    }
    if (*std::max_element(shares.begin(), shares.end()) <= room)
    {
      return static_cast<int>(ranks);
    }
    // However many ranks there are, the first has a block of every segment.
    if (ranks >= most)
    {
      break;
    }
    ranks += std::max<std::uint64_t>(ranks / 64, 1);
  }
  return 0;
}

MemoryOrganization MemoryPlan::Decide(MemoryOrganization wanted) const
{
  if (this->AnyFromSource && wanted != MemoryOrganization::PageBased)
  {
    wanted = MemoryOrganization::ObjectBased;
  }
  if (wanted == MemoryOrganization::Automatic)
  {
    if (this->FindPoorest(MemoryOrganization::Replicated) < 0)
    {
      return MemoryOrganization::Replicated;
    }
    wanted = MemoryOrganization::ObjectBased;
  }
  const int poorest = this->FindPoorest(wanted);
  if (poorest >= 0)
  {
    this->Refuse(wanted, poorest);
  }
  return wanted;
}

void MemoryPlan::Refuse(MemoryOrganization organization, int rank) const
{
  const Budget& budget = this->Budgets[static_cast<std::size_t>(rank)];
  const std::uint64_t need = this->GetNeed(organization, rank);
  const bool replicated = organization == MemoryOrganization::Replicated;
  const bool allOnDisk = std::all_of(this->Segments.begin(), this->Segments.end(),
    [](const BlockDirectory* segment) { return segment->IsFromSource(); });
  std::string text = replicated ? "A copy of all data on every rank takes "
    : allOnDisk ? "Data on a disk need memory for tables, messages and a few bricks, which takes "
                : "The data owned by rank " + std::to_string(rank) + " take ";
  const std::uint64_t limit = replicated ? budget.Bytes : budget.Limit;
  const bool looksEqual = FormatMebibytes(need) == FormatMebibytes(limit);
  text += FormatMebibytes(need) + " (" + std::to_string(need) + " bytes" +
    (replicated || allOnDisk ? "" : ", including a cache of one brick and messages") +
    ") of rank " + std::to_string(rank) + "'s memory. The limit is " + FormatMebibytes(limit) +
    (looksEqual ? " (" + std::to_string(limit) + " bytes)" : "") +
    ". Raise the memory per rank (DSMMemory), " +
    (this->AnyOnOwnersDisk || allOnDisk
        ? ""
        : "set a scratch directory on a disk (DSMScratchDirectory), ");
  if (replicated)
  {
    throw MemoryShortage(
      text + "or choose the object based memory organization (DSMMemoryOrganization).");
  }
  const int ranks = this->FindRankCount(organization);
  throw MemoryShortage(text +
    (ranks > 0 ? "or use at least " + std::to_string(ranks) + " ranks with as much memory."
               : std::string("or use smaller data. More ranks do not help.")));
}

std::string MemoryPlan::Explain(MemoryOrganization wanted, MemoryOrganization chosen) const
{
  if (this->AnyFromSource)
  {
    const bool byAll = wanted == MemoryOrganization::Replicated;
    const std::string scratch = this->AnyOnOwnersDisk
      ? "data that exceed the memory limit are in scratch files (DSMScratchDirectory), and "
      : "";
    return std::string("The memory organization is ") + GetText(byAll ? wanted : chosen) +
      (wanted == MemoryOrganization::Automatic ? "" : ", as chosen") + ": " + scratch +
      "bricks on a disk are read on demand, " +
      (byAll ? "by each rank that needs them" : "once for all ranks") +
      (byAll && this->AnyOnOwnersDisk ? ", and bricks in scratch files once for all ranks." : ".");
  }
  std::string text = std::string("The memory organization is ") + GetText(chosen);
  if (wanted != MemoryOrganization::Automatic)
  {
    return text + ", as chosen.";
  }
  std::uint64_t need = 0;
  std::uint64_t least = UINT64_MAX;
  for (std::size_t rank = 0; rank < this->Budgets.size(); ++rank)
  {
    need = std::max(need, this->GetNeed(MemoryOrganization::Replicated, static_cast<int>(rank)));
    least = std::min(least, this->Budgets[rank].Bytes);
  }
  const bool fits = this->FindPoorest(MemoryOrganization::Replicated) < 0;
  const std::string each = FormatMebibytes(need) + " on a rank, which ";
  text += ": all data take " +
    (this->LargestGroup == 1
        ? each
        : FormatMebibytes(this->Blocks.Total) + " on a host, shared by up to " +
          std::to_string(this->LargestGroup) + " ranks, or " + each) +
    (fits ? "is within" : "exceeds") + " the limit of " + FormatMebibytes(least);
  if (fits && chosen != MemoryOrganization::Replicated)
  {
    text += ", but copying them failed";
  }
  return text + ".";
}

} // namespace dsm
