// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_SegmentUpdate_h
#define dsm_SegmentUpdate_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/transport/Messenger.h"

#include <string_view>
#include <vector>

namespace dsm
{

/// The collective steps by which some of a segment's blocks get other contents, where their owners have
/// them in memory: nobody else has a block of it in use. Communication thread, between frames.
namespace SegmentUpdate
{
/// Collective. `chosen`: for each block, whether it is made anew, out of all ranks' fragments, as when it
/// was published; the same on every rank. `source` yields no fragments of others. Returns which blocks
/// are not as they were, which is known by their hashes on their owners; the same on every rank. Copies
/// that other ranks have of those are not touched. Throws the same Error on every rank when any rank
/// fails; then the chosen blocks have any contents, and the segment is of no use any more.
std::vector<bool> Run(Messenger& messenger, std::string_view what, BlockSegment& segment,
  const std::vector<bool>& chosen, FragmentSource& source, FragmentSink& sink,
  FunctionRef<void(double)> progress);

/// Collective: by block, whether any rank says so. `mine` may throw; then all do.
std::vector<bool> GatherAny(
  Messenger& messenger, std::string_view what, FunctionRef<std::vector<bool>()> mine);
}

} // namespace dsm

#endif
