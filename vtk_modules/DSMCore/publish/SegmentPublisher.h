// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_SegmentPublisher_h
#define dsm_SegmentPublisher_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace dsm
{

/// The collective steps by which the ranks' fragments become the blocks of a segment, whatever
/// memory the store keeps them in: agree, set out memory, fill it, seal.
/// Communication thread, once.
class SegmentPublisher
{
public:
  /// Functions of the store on this rank. Each may throw; then all ranks fail. The objects that
  /// they refer to must outlive the publisher.
  struct Steps
  {
    /// Returns the bytes of this rank's memory that the segment takes.
    FunctionRef<std::uint64_t(const BlockDirectory& directory)> CountBytes;
    /// Sets out zeroed memory for the blocks that this rank owns. The number names the segment, on
    /// all ranks, among those of all stores that share the messenger.
    FunctionRef<std::shared_ptr<BlockSegment>(std::uint32_t number, BlockDirectory&& directory)>
      Create;
    /// Advice for the user if memory does not suffice: a sentence.
    const char* Remedy = "Use more hosts or smaller data.";
  };

  /// `what` names the publication in errors.
  SegmentPublisher(Messenger& messenger, std::string_view what, const Steps& steps);

  /// Collective: the segment, with nothing in it yet. Throws as Run.
  std::shared_ptr<BlockSegment> Create(BlockDirectory directory);
  /// Collective. Throws the same Error on every rank when any rank fails, when the ranks'
  /// directories differ, and, before any takes memory, when that does not suffice. `progress` may be
  /// empty.
  std::shared_ptr<BlockSegment> Run(BlockDirectory directory, FragmentSource& source,
    FragmentSink& sink, FunctionRef<void(double)> progress);

private:
  /// `begin` takes part in the ranks' agreement.
  std::shared_ptr<BlockSegment> Create(
    BlockDirectory&& directory, FunctionRef<void(const BlockSegment&)> begin);
  void Check(const BlockDirectory& directory, const std::vector<std::uint64_t>& fingerprints) const;
  void CheckMemory(std::uint64_t bytes, int ranksOnHost, std::uint64_t available) const;

  Messenger& Messages;
  std::string_view What;
  Steps Store;
};

} // namespace dsm

#endif
