// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_SegmentPublisher_h
#define dsm_SegmentPublisher_h

#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace dsm
{

/// The collective steps by which the ranks' fragments become the blocks of a segment, whatever
/// memory the store keeps them in. Communication thread, once.
class SegmentPublisher
{
public:
  /// What the store does on this rank; each may throw, then all ranks fail.
  struct Steps
  {
    /// Sets out zeroed memory for the blocks that this rank owns. The number names the segment, on
    /// all ranks, among those of all stores that share the messenger.
    std::function<void(std::uint32_t number, BlockDirectory&& directory)> Allocate;
    /// Where a block that this rank owns lies, once allocated.
    std::function<std::byte*(BlockId)> Locate;
    /// After the last fragment, when the sink has finished every block.
    std::function<void()> Seal;
  };

  /// `what` names the publication in errors.
  SegmentPublisher(Messenger& messenger, std::string what, Steps steps);

  /// Collective. Throws the same Error on every rank when any rank fails, or when the ranks'
  /// directories differ. `progress` may be empty.
  void Run(BlockDirectory directory, FragmentSource& source, FragmentSink& sink,
    const std::function<void(double)>& progress);

private:
  void Check(const BlockDirectory& directory, const std::vector<std::uint64_t>& fingerprints) const;
  void ForEachOwned(const BlockDirectory& directory,
    const std::function<void(BlockId, std::byte*, std::size_t)>& visit) const;

  Messenger& Messages;
  std::string What;
  Steps Store;
};

} // namespace dsm

#endif
