// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/SegmentPublisher.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/publish/FragmentStream.h"

#include <algorithm>
#include <utility>

namespace dsm
{

namespace
{

template <class Visit>
void ForEachOwned(const BlockSegment& segment, int rank, const Visit& visit)
{
  const BlockDirectory& directory = segment.GetDirectory();
  for (BlockId id = 0; id < directory.GetCount(); ++id)
  {
    if (directory.GetOwner(id) == rank)
    {
      visit(id, segment.GetOwned(id), directory.GetBytes(id));
    }
  }
}

} // namespace

SegmentPublisher::SegmentPublisher(Messenger& messenger, std::string_view what, const Steps& steps)
  : Messages(messenger)
  , What(what)
  , Store(steps)
{
}

std::shared_ptr<BlockSegment> SegmentPublisher::Create(BlockDirectory directory)
{
  return this->Create(std::move(directory), [](const BlockSegment&) {});
}

std::shared_ptr<BlockSegment> SegmentPublisher::Create(
  BlockDirectory&& directory, FunctionRef<void(const BlockSegment&)> begin)
{
  const int ranksOnHost = this->Messages.GetRanksOnHost();
  FirstFailure failure;
  // Asked before the ranks meet in the next line, hence before any of them takes memory.
  std::uint64_t available = 0;
  failure.Try([&] { available = GetAvailableHostMemory(); });
  const auto fingerprints = this->Messages.AllGatherValue(directory.GetFingerprint());
  // Stores that share a messenger draw from one sequence, so the number identifies the segment in all of them.
  const std::uint32_t number = this->Messages.BeginSession();
  std::shared_ptr<BlockSegment> segment;
  this->Messages.RunTogether(this->What,
    [&]
    {
      failure.Throw();
      this->Check(directory, fingerprints);
      this->CheckMemory(this->Store.CountBytes(directory), ranksOnHost, available);
      segment = this->Store.Create(number, std::move(directory));
      begin(*segment);
    });
  return segment;
}

std::shared_ptr<BlockSegment> SegmentPublisher::Run(BlockDirectory directory,
  FragmentSource& source, FragmentSink& sink, FunctionRef<void(double)> progress)
{
  const int rank = this->Messages.GetRank();
  const auto begin = [&](const BlockSegment& created)
  {
    ForEachOwned(created, rank,
      [&](BlockId id, std::byte* block, std::size_t bytes) { sink.Begin(id, block, bytes); });
  };
  const auto segment = this->Create(std::move(directory), begin);
  segment->Meet(this->Messages);

  const auto absorb = [&](BlockId id, const std::byte* bytes, std::size_t count)
  { sink.Absorb(id, segment->GetOwned(id), segment->GetDirectory().GetBytes(id), bytes, count); };
  const FirstFailure failure =
    FragmentStream::Run(this->Messages, segment->GetDirectory(), source, absorb, progress);
  this->Messages.RunTogether(this->What,
    [&]
    {
      failure.Throw();
      ForEachOwned(*segment, rank,
        [&](BlockId id, std::byte* block, std::size_t bytes) { sink.Finish(id, block, bytes); });
      segment->Seal();
      if (progress)
      {
        progress(1.0);
      }
    });
  segment->Open();
  return segment;
}

void SegmentPublisher::Check(
  const BlockDirectory& directory, const std::vector<std::uint64_t>& fingerprints) const
{
  if (std::count(fingerprints.begin(), fingerprints.end(), fingerprints.front()) !=
    this->Messages.GetSize())
  {
    throw Error("The ranks disagree on the number, sizes or owners of the blocks. Do all ranks see "
                "the same extent of the data?");
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

/// Blocks are dealt evenly, so the other ranks of the host want as much as this one.
void SegmentPublisher::CheckMemory(
  std::uint64_t bytes, int ranksOnHost, std::uint64_t available) const
{
  if (bytes > available / static_cast<std::uint64_t>(ranksOnHost))
  {
    throw Error("out of memory: " + FormatMebibytes(bytes) + " are required for each of " +
      std::to_string(ranksOnHost) + " ranks on the host, which has " + FormatMebibytes(available) +
      " available. " + this->Store.Remedy);
  }
}

} // namespace dsm
