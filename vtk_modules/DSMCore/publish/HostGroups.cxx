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

std::shared_ptr<const HostGroups> HostGroups::Find(Messenger& messenger, bool wanted)
{
  constexpr const char* what = "Sharing memory within hosts";
  const auto size = static_cast<std::size_t>(messenger.GetSize());
  const auto own = static_cast<std::size_t>(messenger.GetRank());
  std::vector<int> hosts;
  std::shared_ptr<const HostGroups> groups;
  if (size == 1)
  {
    return std::make_shared<const HostGroups>(Separate(1));
  }
  messenger.GetHosts(); // collective the first time
  HostSharedMemory trial;
  std::vector<std::byte> reached;
  messenger.RunTogether(what,
    [&]
    {
      hosts = messenger.GetHosts();
      reached.assign(size, std::byte{ 0 });
      trial = HostSharedMemory(1, wanted);
    });
  const auto tickets = messenger.AllGatherValue(trial.GetTicket());
  std::vector<std::vector<std::byte>> all;
  if (std::any_of(tickets.begin(), tickets.end(), [](const auto& t) { return t.File >= 0; }))
  {
    for (std::size_t rank = 0; rank < size; ++rank)
    {
      if (hosts[rank] == hosts[own] && tickets[own].File >= 0 &&
        HostSharedMemory::Open(tickets[rank]))
      {
        reached[rank] = std::byte{ 1 };
      }
    }
    all = messenger.AllGather(std::move(reached));
  }
  messenger.RunTogether(what,
    [&]
    {
      std::vector<int> leaders(size);
      std::iota(leaders.begin(), leaders.end(), 0);
      // Group the ranks of a host that offered memory; one pair that fails dissolves the host's
      // group.
      std::vector<bool> whole(size, true); // by lowest rank of the host
      const auto areMates = [&](std::size_t a, std::size_t b)
      { return hosts[a] == hosts[b] && tickets[a].File >= 0 && tickets[b].File >= 0; };
      for (std::size_t a = 0; a < all.size(); ++a)
      {
        for (std::size_t b = 0; b < all.size(); ++b)
        {
          if (areMates(a, b) && all[a][b] == std::byte{ 0 })
          {
            whole[static_cast<std::size_t>(hosts[a])] = false;
          }
        }
      }
      for (std::size_t a = 0; a < all.size(); ++a)
      {
        for (std::size_t b = 0; b < a && leaders[a] == static_cast<int>(a); ++b)
        {
          if (areMates(a, b) && whole[static_cast<std::size_t>(hosts[a])])
          {
            leaders[a] = static_cast<int>(b);
          }
        }
      }
      groups = std::make_shared<const HostGroups>(leaders);
    });
  return groups;
}

int HostGroups::GetHolder(BlockId id, int owner, int group) const
{
  if (this->GetGroup(owner) == group)
  {
    return owner;
  }
  const auto& members = this->Groups[static_cast<std::size_t>(group)];
  return members[this->GetTurn(id, members.size())];
}

} // namespace dsm
