// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/SegmentUpdate.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/publish/FragmentDigests.h"
#include "DSMCore/publish/FragmentStream.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

namespace dsm
{

namespace
{

ByteDigest Digest(const BlockSegment& segment, BlockId id)
{
  ByteDigest digest;
  digest.Add(segment.GetOwned(id), segment.GetDirectory().GetBytes(id));
  return digest;
}

} // namespace

std::vector<bool> SegmentUpdate::GatherAny(
  Messenger& messenger, std::string_view what, FunctionRef<std::vector<bool>()> mine)
{
  std::size_t count = 0;
  const auto all = messenger.GatherTogether(what,
    [&]
    {
      const std::vector<bool> flags = mine();
      count = flags.size();
      std::vector<std::byte> ids; // few, as a rule
      for (BlockId id = 0; id < flags.size(); ++id)
      {
        if (flags[id])
        {
          AttachTail(ids, id);
        }
      }
      return ids;
    });
  std::vector<bool> any;
  messenger.RunTogether(what,
    [&]
    {
      any.assign(count, false);
      for (const std::vector<std::byte>& ids : all)
      {
        for (std::size_t at = 0; at + sizeof(BlockId) <= ids.size(); at += sizeof(BlockId))
        {
          BlockId id = 0;
          std::memcpy(&id, ids.data() + at, sizeof(id));
          any.at(id) = true;
        }
      }
    });
  return any;
}

std::vector<bool> SegmentUpdate::Run(Messenger& messenger, std::string_view what,
  BlockSegment& segment, const std::vector<bool>& chosen, FragmentSource& source,
  FragmentSink& sink, FunctionRef<void(double)> progress)
{
  const BlockDirectory& directory = segment.GetDirectory();
  std::vector<std::pair<BlockId, ByteDigest>> owned; // as they were
  messenger.RunTogether(what,
    [&]
    {
      for (BlockId id = 0; id < directory.GetCount(); ++id)
      {
        if (chosen[id] && directory.GetOwner(id) == messenger.GetRank())
        {
          owned.emplace_back(id, Digest(segment, id));
        }
      }
      segment.Unseal();
      for (const auto& [id, before] : owned)
      {
        std::byte* const block = segment.GetOwned(id);
        std::fill_n(block, directory.GetBytes(id), std::byte{ 0 });
        sink.Begin(id, block, directory.GetBytes(id));
      }
    });
  const auto absorb = [&](BlockId id, const std::byte* bytes, std::size_t count)
  {
    if (!chosen[id])
    {
      throw Error("A fragment was produced for block " + std::to_string(id) +
        ", which must not change. This is a bug in the program.");
    }
    sink.Absorb(id, segment.GetOwned(id), directory.GetBytes(id), bytes, count);
  };
  const FirstFailure failure = FragmentStream::Run(messenger, directory, source, absorb, progress);
  return GatherAny(messenger, what,
    [&]
    {
      failure.Throw();
      std::vector<bool> changed(directory.GetCount());
      for (const auto& [id, before] : owned)
      {
        sink.Finish(id, segment.GetOwned(id), directory.GetBytes(id));
        changed[id] = Digest(segment, id) != before;
      }
      segment.Reseal();
      if (progress)
      {
        progress(1.0);
      }
      return changed;
    });
}

} // namespace dsm
