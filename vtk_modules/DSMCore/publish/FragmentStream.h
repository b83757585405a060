// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FragmentStream_h
#define dsm_FragmentStream_h

#include "DSMCore/base/FirstFailure.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <string_view>

namespace dsm
{

/// Moves every rank's fragments to the owners of their blocks, in a bounded stream (BlockStream).
/// Communication thread.
class FragmentStream
{
public:
  /// A fragment of a block that this rank owns; may throw.
  using Absorb = FunctionRef<void(BlockId id, const std::byte* bytes, std::size_t count)>;

  /// Collective; begins a session. `progress` (may be empty) receives this rank's completed part, below 1.
  /// Returns this rank's failure; the caller has to let the ranks agree.
  static FirstFailure Run(Messenger& messenger, const BlockDirectory& directory,
    FragmentSource& source, Absorb absorb, FunctionRef<void(double)> progress);

  /// Collective: moves fragments to ranks; block n is what rank n gets. Throws the same Error on every rank.
  static void RunToRanks(
    std::string_view what, Messenger& messenger, FragmentSource& source, Absorb absorb);
};

} // namespace dsm

#endif
