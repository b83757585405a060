// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/SegmentPublisher.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/publish/FragmentExchange.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace dsm
{

namespace
{

/// Equal directories have equal ones (FNV-1a).
std::uint64_t GetFingerprint(const BlockDirectory& directory)
{
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (BlockId id = 0; id < directory.GetCount(); ++id)
  {
    hash = (hash ^ directory.GetBytes(id)) * 0x100000001b3u;
    hash = (hash ^ static_cast<std::uint64_t>(directory.GetOwner(id))) * 0x100000001b3u;
  }
  return hash;
}

/// Blocks are dealt evenly, so the other ranks of the host want as much as this one.
void CheckHostMemory(std::uint64_t bytes, int ranksOnHost, std::uint64_t available)
{
  if (bytes > available / static_cast<std::uint64_t>(ranksOnHost))
  {
    throw Error("out of memory: " + std::to_string(bytes >> 20) + " MiB are needed for each of " +
      std::to_string(ranksOnHost) + " ranks on the host, which has " +
      std::to_string(available >> 20) +
      " MiB left. Use more hosts, so that each holds fewer bytes, or smaller data.");
  }
}

} // namespace

SegmentPublisher::SegmentPublisher(Messenger& messenger, std::string what, Steps steps)
  : Messages(messenger)
  , What(std::move(what))
  , Store(std::move(steps))
{
}

void SegmentPublisher::Run(BlockDirectory directory, FragmentSource& source, FragmentSink& sink,
  const std::function<void(double)>& progress)
{
  // Stores that share a messenger draw from one sequence, so the number names the segment among all
  // of theirs.
  const std::uint32_t number = this->Messages.BeginSession();
  const int ranksOnHost = this->Messages.GetRanksOnHost();
  // Asked before the ranks meet in the next line, hence before any of them takes memory.
  const std::uint64_t available = GetAvailableHostMemory();
  const auto fingerprints = this->Messages.AllGatherValue(GetFingerprint(directory));
  std::optional<BlockDirectory> copy;
  this->Messages.RunTogether(this->What,
    [&]
    {
      const BlockDirectory& blocks = copy.emplace(directory);
      this->Check(blocks, fingerprints);
      CheckHostMemory(blocks.GetResidentBytes(this->Messages.GetRank()), ranksOnHost, available);
      this->Store.Allocate(number, std::move(directory));
      this->ForEachOwned(blocks,
        [&](BlockId id, std::byte* block, std::size_t bytes) { sink.Begin(id, block, bytes); });
    });

  const BlockDirectory& blocks = *copy;
  this->Messages.BeginSession();
  std::string cause;
  {
    FragmentExchange exchange(this->Messages, blocks, this->Store.Locate);
    cause = exchange.Run(source, sink, progress);
  }

  this->Messages.RunTogether(this->What,
    [&]
    {
      if (!cause.empty())
      {
        throw Error(cause);
      }
      this->ForEachOwned(blocks,
        [&](BlockId id, std::byte* block, std::size_t bytes) { sink.Finish(id, block, bytes); });
      this->Store.Seal();
      if (progress)
      {
        progress(1.0);
      }
    });
}

void SegmentPublisher::Check(
  const BlockDirectory& directory, const std::vector<std::uint64_t>& fingerprints) const
{
  if (std::count(fingerprints.begin(), fingerprints.end(), fingerprints.front()) !=
    this->Messages.GetSize())
  {
    throw Error("The ranks disagree about the number, the sizes or the owners of the blocks. Do "
                "all ranks see the same extent of the data?");
  }
  for (BlockId id = 0; id < directory.GetCount(); ++id)
  {
    if (directory.GetOwner(id) < 0 || directory.GetOwner(id) >= this->Messages.GetSize())
    {
      throw Error("Block " + std::to_string(id) + " was assigned to rank " +
        std::to_string(directory.GetOwner(id)) + ", but there are " +
        std::to_string(this->Messages.GetSize()) + " ranks.");
    }
  }
}

void SegmentPublisher::ForEachOwned(const BlockDirectory& directory,
  const std::function<void(BlockId, std::byte*, std::size_t)>& visit) const
{
  for (BlockId id = 0; id < directory.GetCount(); ++id)
  {
    if (directory.GetOwner(id) == this->Messages.GetRank())
    {
      visit(id, this->Store.Locate(id), directory.GetBytes(id));
    }
  }
}

} // namespace dsm
