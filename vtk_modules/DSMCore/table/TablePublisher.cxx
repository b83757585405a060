// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/TablePublisher.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/memory/HostMemory.h"
#include "DSMCore/publish/SegmentPublisher.h"

#include <algorithm>
#include <utility>

namespace dsm
{

namespace
{

/// Blocks are dealt evenly, so the other ranks of the host want as much as this one.
void CheckMemory(
  std::uint64_t bytes, const TablePublisher::Plan& plan, int ranksOnHost, std::uint64_t available)
{
  const std::string remedy = plan.Replicate
    ? "Choose the object based memory organisation (DSMMemoryOrganization), which shares the data "
      "out between the ranks, or smaller data."
    : "Use more hosts, so that each holds fewer bytes, or smaller data.";
  if (bytes > available / static_cast<std::uint64_t>(ranksOnHost))
  {
    throw Error("out of memory: " + FormatMebibytes(bytes) + " are needed for each of " +
      std::to_string(ranksOnHost) + " ranks on the host, which has " + FormatMebibytes(available) +
      " left. " + remedy);
  }
  if (bytes > plan.MemoryBytes)
  {
    throw Error("out of memory: " + FormatMebibytes(bytes) + " (" + std::to_string(bytes) +
      " bytes) are needed, but of the memory that a rank may take (DSMMemory) only " +
      FormatMebibytes(plan.MemoryBytes) + " are left. " + remedy);
  }
}

} // namespace

std::shared_ptr<BlockTable> TablePublisher::Run(Messenger& messenger, const std::string& what,
  const Plan& plan, BlockDirectory directory, FragmentSource& source, FragmentSink& sink,
  const std::function<void(double)>& progress)
{
  const HostGroups groups =
    plan.Groups ? *plan.Groups : HostGroups::Find(messenger, plan.HostSharing);
  const int ranksOnHost = messenger.GetRanksOnHost();
  // Asked before the ranks meet in the next steps, hence before any of them takes memory.
  const std::uint64_t available = GetAvailableHostMemory();
  std::shared_ptr<BlockTable> table;
  SegmentPublisher::Steps steps;
  steps.Allocate = [&](std::uint32_t number, BlockDirectory&& blocks)
  {
    if (plan.Check)
    {
      plan.Check();
    }
    const int rank = messenger.GetRank();
    std::uint64_t bytes = blocks.GetResidentBytes(rank);
    if (plan.Replicate)
    {
      bytes += BlockTable::CountReplicaBytes(blocks, groups, rank);
    }
    CheckMemory(bytes, plan, ranksOnHost, available);
    table = std::make_shared<BlockTable>(number, std::move(blocks), rank, groups);
  };
  steps.Locate = [&](BlockId id) { return table->GetOwned(id); };
  steps.Seal = [] {};
  SegmentPublisher(messenger, what, std::move(steps))
    .Run(std::move(directory), source, sink, progress);
  table->ShareWithGroup(messenger);
  if (plan.Replicate)
  {
    table->Replicate(messenger, what);
  }
  return table;
}

} // namespace dsm
