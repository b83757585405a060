// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/HostGroups.h"

#include "DSMCore/memory/HostSharedMemory.h"
#include "DSMCore/transport/Messenger.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace dsm
{

HostGroups::HostGroups(const std::vector<int>& leaders)
  : GroupOf(leaders.size(), 0)
{
  for (std::size_t rank = 0; rank < leaders.size(); ++rank)
  {
    const auto leader = static_cast<std::size_t>(leaders[rank]);
    if (leader == rank)
    {
      this->GroupOf[rank] = static_cast<int>(this->Groups.size());
      this->Groups.emplace_back();
    }
    else
    {
      this->GroupOf[rank] = this->GroupOf[leader];
    }
    this->Groups[static_cast<std::size_t>(this->GroupOf[rank])].push_back(static_cast<int>(rank));
  }
}

HostGroups HostGroups::Separate(int ranks)
{
  std::vector<int> leaders(static_cast<std::size_t>(ranks));
  std::iota(leaders.begin(), leaders.end(), 0);
  return HostGroups(leaders);
}

HostGroups HostGroups::Find(Messenger& messenger, bool wanted)
{
  const int size = messenger.GetSize();
  const std::vector<int> hosts = messenger.GetHosts();
  if (size == 1)
  {
    return Separate(size);
  }
  HostSharedMemory trial(1, wanted);
  const auto tickets = messenger.AllGatherValue(trial.GetTicket());
  if (std::none_of(tickets.begin(), tickets.end(), [](const auto& t) { return t.File >= 0; }))
  {
    return Separate(size);
  }
  const int own = messenger.GetRank();
  std::vector<std::byte> reached(static_cast<std::size_t>(size), std::byte{ 0 });
  for (std::size_t rank = 0; rank < reached.size(); ++rank)
  {
    if (hosts[rank] == hosts[static_cast<std::size_t>(own)] &&
      tickets[static_cast<std::size_t>(own)].File >= 0 && HostSharedMemory::Open(tickets[rank]))
    {
      reached[rank] = std::byte{ 1 };
    }
  }
  const auto all = messenger.AllGather(std::move(reached));
  std::vector<int> leaders(static_cast<std::size_t>(size));
  std::iota(leaders.begin(), leaders.end(), 0);
  // Of a host, those who offered memory; one pair that fails undoes the host.
  std::vector<bool> whole(static_cast<std::size_t>(size), true); // by lowest rank of the host
  for (std::size_t a = 0; a < all.size(); ++a)
  {
    for (std::size_t b = 0; b < all.size(); ++b)
    {
      if (hosts[a] == hosts[b] && tickets[a].File >= 0 && tickets[b].File >= 0 &&
        all[a][b] == std::byte{ 0 })
      {
        whole[static_cast<std::size_t>(hosts[a])] = false;
      }
    }
  }
  for (std::size_t a = 0; a < all.size(); ++a)
  {
    for (std::size_t b = 0; b < a; ++b)
    {
      if (hosts[a] == hosts[b] && whole[static_cast<std::size_t>(hosts[a])] &&
        tickets[a].File >= 0 && tickets[b].File >= 0)
      {
        leaders[a] = static_cast<int>(b);
        break;
      }
    }
  }
  return HostGroups(leaders);
}

int HostGroups::GetHolder(BlockId id, int owner, int group) const
{
  if (this->GetGroup(owner) == group)
  {
    return owner;
  }
  // Divided by the number of ranks first: else one owner's blocks would all go to one member.
  const auto& members = this->Groups[static_cast<std::size_t>(group)];
  return members[(id / this->GroupOf.size()) % members.size()];
}

} // namespace dsm
