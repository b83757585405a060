// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/BlockSpread.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/publish/BlockStream.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace dsm
{

FirstFailure BlockSpread::Run(Messenger& messenger, const BlockDirectory& directory,
  const HostGroups& groups, Source source, Destination destination, const std::vector<bool>* only)
{
  const int rank = messenger.GetRank();
  const int ownGroup = groups.GetGroup(rank);
  const auto take = [&](int from, BlockId id, const std::byte* bytes, std::size_t count)
  {
    if (id >= directory.GetCount() || directory.GetOwner(id) != from ||
      groups.AreTogether(rank, from) || groups.GetHolder(id, from, ownGroup) != rank ||
      directory.GetBytes(id) != count || (only && !(*only)[id]))
    {
      throw Error("Rank " + std::to_string(from) + " sent " + std::to_string(count) +
        " bytes as a copy of block " + std::to_string(id) +
        ", which this rank does not expect. Do all ranks run the same build?");
    }
    std::copy_n(bytes, count, destination(id));
  };
  messenger.BeginSession();
  BlockStream stream(messenger, take);
  BlockId next = 0; // the block, and the group, that are sent next
  int group = 0;
  const auto feed = [&]
  {
    for (; next < directory.GetCount(); ++next, group = 0)
    {
      if (directory.GetOwner(next) != rank || (only && !(*only)[next]))
      {
        continue;
      }
      group += group == ownGroup ? 1 : 0;
      if (group < groups.GetGroupCount())
      {
        constexpr std::size_t tails = 64; // the stream's, and the transport's
        const std::byte* const bytes = source(next);
        std::vector<std::byte> payload;
        payload.reserve(directory.GetBytes(next) + tails);
        payload.assign(bytes, bytes + directory.GetBytes(next));
        stream.Post(groups.GetHolder(next, rank, group), next, std::move(payload));
        ++group;
        return true;
      }
    }
    return false;
  };
  return stream.Run(feed);
}

} // namespace dsm
