// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockSpread_h
#define dsm_BlockSpread_h

#include "DSMCore/base/FirstFailure.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/HostGroups.h"
#include "DSMCore/publish/StreamEnd.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <functional>

namespace dsm
{

/// Sends a copy of every block from its owner to each group that does not own it (to
/// HostGroups::GetHolder), in a bounded stream: an owner sends the next block only while few of its
/// bytes wait for their receivers. Communication thread, once.
class BlockSpread
{
public:
  /// Where a block lies that this rank owns, or holds a copy of.
  using Source = std::function<const std::byte*(BlockId)>;
  using Destination = std::function<std::byte*(BlockId)>;

  BlockSpread(Messenger& messenger, const BlockDirectory& directory, const HostGroups& groups,
    Source source, Destination destination);
  ~BlockSpread();
  BlockSpread(const BlockSpread&) = delete;
  BlockSpread& operator=(const BlockSpread&) = delete;

  /// Collective; the session must have been begun for it. Returns when every copy is where it
  /// belongs, or the rank that should have sent it has failed; it is for the caller to let the ranks
  /// agree.
  void Run();
  /// Throws what went wrong on this rank, if anything did.
  void ThrowFailure() const { this->Failure.Throw(); }

private:
  bool Feed();
  /// False when there is nothing left.
  bool SendNext();
  void Receive(Message&& message);

  Messenger& Messages;
  const BlockDirectory& Directory;
  const HostGroups& Groups;
  Source From;
  Destination To;
  StreamEnd End;
  BlockId Next = 0; ///< the block, and the group, that are sent next
  int NextGroup = 0;
  FirstFailure Failure;
};

} // namespace dsm

#endif
