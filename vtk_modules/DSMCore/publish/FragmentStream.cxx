// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/FragmentStream.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/publish/BlockStream.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dsm
{

namespace
{

/// Smallest advance that is worth to be shown.
constexpr double ProgressStep = 0.01;

} // namespace

FirstFailure FragmentStream::Run(Messenger& messenger, const BlockDirectory& directory,
  FragmentSource& source, Absorb absorb, FunctionRef<void(double)> progress)
{
  const int rank = messenger.GetRank();
  const auto take = [&](int from, BlockId id, const std::byte* bytes, std::size_t count)
  {
    if (id >= directory.GetCount() || directory.GetOwner(id) != rank)
    {
      throw Error("Rank " + std::to_string(from) + " sent a fragment of block " +
        std::to_string(id) + ", which this rank does not own. Do all ranks run the same build?");
    }
    absorb(id, bytes, count);
  };
  messenger.BeginSession();
  BlockStream stream(messenger, take);
  double shown = -1.0;
  const auto feed = [&]
  {
    Fragment fragment;
    if (!source.Next(fragment))
    {
      return false;
    }
    if (fragment.Block >= directory.GetCount())
    {
      throw Error("A fragment was produced for block " + std::to_string(fragment.Block) +
        ", but there are only " + std::to_string(directory.GetCount()) + ".");
    }
    const int owner = directory.GetOwner(fragment.Block);
    if (owner == rank)
    {
      absorb(fragment.Block, fragment.Bytes.data(), fragment.Bytes.size());
    }
    else
    {
      stream.Post(owner, fragment.Block, std::move(fragment.Bytes));
    }
    const double part = std::clamp(source.GetProgress(), 0.0, 1.0);
    if (progress && part >= shown + ProgressStep && part < 1.0) // all is not done yet
    {
      shown = part;
      progress(part);
    }
    return true;
  };
  return stream.Run(feed);
}

void FragmentStream::RunToRanks(
  std::string_view what, Messenger& messenger, FragmentSource& source, Absorb absorb)
{
  std::optional<BlockDirectory> directory;
  messenger.RunTogether(what,
    [&]
    {
      const int ranks = messenger.GetSize();
      directory.emplace(
        std::vector<std::uint32_t>(static_cast<std::size_t>(ranks), 0), RoundRobinAssigner(ranks));
    });
  const FirstFailure failure = Run(messenger, *directory, source, absorb, {});
  messenger.RunTogether(what, [&] { failure.Throw(); });
}

} // namespace dsm
