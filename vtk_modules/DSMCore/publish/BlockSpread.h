// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockSpread_h
#define dsm_BlockSpread_h

#include "DSMCore/base/FirstFailure.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/HostGroups.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <vector>

namespace dsm
{

/// Sends a copy of every block from its owner to each group that does not own it (to
/// HostGroups::GetHolder), in a bounded stream (BlockStream). Communication thread.
class BlockSpread
{
public:
  /// Returns the address of a block that this rank owns, or holds a copy of.
  using Source = FunctionRef<const std::byte*(BlockId)>;
  using Destination = FunctionRef<std::byte*(BlockId)>;

  /// Collective; begins a session. Returns when every copy is where it belongs, or the rank that should
  /// have sent it has failed: what has gone wrong on this rank. It is for the caller to let the ranks
  /// agree.
  /// `only` (null: all): which blocks, the same on every rank.
  static FirstFailure Run(Messenger& messenger, const BlockDirectory& directory,
    const HostGroups& groups, Source source, Destination destination,
    const std::vector<bool>* only = nullptr);
};

} // namespace dsm

#endif
