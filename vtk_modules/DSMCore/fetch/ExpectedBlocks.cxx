// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/fetch/ExpectedBlocks.h"

#include <algorithm>
#include <new>
#include <utility>

namespace dsm
{

ExpectedBlocks::Ids ExpectedBlocks::ListUsed(
  const BlockSegment& segment, FunctionRef<Ids()> listCached) const
{
  Ids blocks = listCached();
  const auto unused = this->Unused.find(&segment);
  if (unused != this->Unused.end())
  {
    blocks.erase(std::remove_if(blocks.begin(), blocks.end(),
                   [&](BlockId id) { return unused->second.count(id) != 0; }),
      blocks.end());
  }
  std::sort(blocks.begin(), blocks.end());
  return blocks;
}

void ExpectedBlocks::NoteRetired(
  const BlockSegment& segment, FunctionRef<Ids()> listCached) noexcept
{
  try
  {
    Ids blocks = this->ListUsed(segment, listCached);
    if (!blocks.empty())
    {
      this->Gone.push_back({ segment.GetDirectory().GetFingerprint(), std::move(blocks) });
    }
  }
  catch (const std::bad_alloc&)
  {
  }
  this->Wanted.erase(&segment);
  this->Unused.erase(&segment);
}

void ExpectedBlocks::NoteAdded(const BlockSegment& segment) noexcept
{
  if (this->Gone.empty())
  {
    return;
  }
  // Take the last of several equal fingerprints: a volume's colors are retired before its isosurface array, and
  // published after it.
  const std::uint64_t fingerprint = segment.GetDirectory().GetFingerprint();
  const auto like = std::find_if(this->Gone.rbegin(), this->Gone.rend(),
    [=](const Retired& retired) { return retired.Fingerprint == fingerprint; });
  if (like == this->Gone.rend())
  {
    return;
  }
  try
  {
    this->Wanted[&segment] = std::move(like->Blocks);
  }
  catch (const std::bad_alloc&)
  {
  }
  this->Gone.erase(std::next(like).base());
}

ExpectedBlocks::Ids ExpectedBlocks::NoteChanged(const BlockSegment& segment,
  const std::vector<bool>& which, FunctionRef<Ids()> listCached) noexcept
{
  try
  {
    Ids kept = this->ListUsed(segment, listCached);
    const auto changed =
      std::stable_partition(kept.begin(), kept.end(), [&](BlockId id) { return !which[id]; });
    Ids& wanted = this->Wanted[&segment];
    wanted.insert(wanted.end(), changed, kept.end());
    kept.erase(changed, kept.end());
    return kept;
  }
  catch (const std::bad_alloc&)
  {
    return {};
  }
}

void ExpectedBlocks::BeginFrame(FunctionRef<void(const BlockSegment&, const Ids&)> visit)
{
  this->Gone.clear();
  const auto wanted = std::exchange(this->Wanted, {});
  for (const auto& [segment, blocks] : wanted)
  {
    visit(*segment, blocks);
  }
}

void ExpectedBlocks::NoteUnused(const BlockWant& block) noexcept
{
  try
  {
    this->Unused[block.From].insert(block.Id);
  }
  catch (const std::bad_alloc&)
  {
  }
}

} // namespace dsm
