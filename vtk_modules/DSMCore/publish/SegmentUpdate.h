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

/// Collective steps that change some of a segment's blocks in their owners' memory. No other user may have a
/// block of the segment in use. Communication thread, between frames.
namespace SegmentUpdate
{
/// Collective. `chosen`: for each block, whether it is built again out of all ranks' fragments, as when it
/// was published; the same on every rank. `source` yields no fragments of other blocks. Returns the blocks
/// that differ from before, determined by hashes on their owners; the same on every rank. Copies of these on
/// other ranks are not touched. Throws the same Error on every rank when any rank fails; then the contents of
/// the chosen blocks are undefined, and the segment must not be used any more.
std::vector<bool> Run(Messenger& messenger, std::string_view what, BlockSegment& segment,
  const std::vector<bool>& chosen, FragmentSource& source, FragmentSink& sink,
  FunctionRef<void(double)> progress);

/// Collective: returns for each block whether it is true on any rank. `mine` may throw; then all ranks throw.
std::vector<bool> GatherAny(
  Messenger& messenger, std::string_view what, FunctionRef<std::vector<bool>()> mine);
}

} // namespace dsm

#endif
