// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_HostGroups_h
#define dsm_HostGroups_h

#include "DSMCore/base/Block.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace dsm
{

class Messenger;

/// Which ranks read one another's memory in place: those of one host, or each alone. The same on
/// every rank.
class HostGroups
{
public:
  HostGroups() = default;
  /// For every rank the lowest rank of its group.
  explicit HostGroups(const std::vector<int>& leaders);

  /// Every rank on its own.
  static HostGroups Separate(int ranks);

  /// Collective: the ranks of a host that all want to share, once each has mapped a trial page of
  /// every other; where one of them cannot, all of that host stay on their own. Throws the same Error
  /// on every rank when one has no memory.
  static std::shared_ptr<const HostGroups> Find(Messenger& messenger, bool wanted);

  /// The ranks of a rank's group, itself included, ascending.
  const std::vector<int>& GetMembers(int rank) const
  {
    return this->Groups[static_cast<std::size_t>(this->GroupOf[static_cast<std::size_t>(rank)])];
  }
  int GetGroup(int rank) const { return this->GroupOf[static_cast<std::size_t>(rank)]; }
  int GetRankCount() const { return static_cast<int>(this->GroupOf.size()); }
  int GetGroupCount() const { return static_cast<int>(this->Groups.size()); }
  bool AreTogether(int a, int b) const { return this->GetGroup(a) == this->GetGroup(b); }

  /// Returns the member of a group that holds a block if all groups hold all blocks: the owner if
  /// it is in the group, otherwise the members in turn.
  int GetHolder(BlockId id, int owner, int group) const;
  /// Returns the index of that member, in a group of so many members.
  std::size_t GetTurn(BlockId id, std::size_t members) const
  {
    // Divided by the number of ranks first: else one owner's blocks would all go to one member.
    return id / this->GroupOf.size() % members;
  }

private:
  std::vector<int> GroupOf;
  std::vector<std::vector<int>> Groups;
};

} // namespace dsm

#endif
