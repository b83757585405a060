// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ExpectedBlocks_h
#define dsm_ExpectedBlocks_h

#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/fetch/BlockSource.h"

#include <cstdint>
#include <map>
#include <unordered_set>
#include <vector>

namespace dsm
{

/// Blocks that left memory recently and that a frame will probably need: those of a segment that
/// replaces a similar one since the last frame, as a time step replaces the one before, and those
/// whose contents have changed. Each rank knows its own. Under the store's lock. Does not fail: it
/// expects fewer blocks if memory is short.
class ExpectedBlocks
{
public:
  using Ids = std::vector<BlockId>;

  /// Between frames. `listCached`: the segment's blocks that are here; may throw.
  void NoteRetired(const BlockSegment& segment, FunctionRef<Ids()> listCached) noexcept;
  void NoteAdded(const BlockSegment& segment) noexcept;
  /// Returns those that were used and have not changed.
  Ids NoteChanged(const BlockSegment& segment, const std::vector<bool>& which,
    FunctionRef<Ids()> listCached) noexcept;

  /// `visit` is called for each segment of which blocks are expected.
  void BeginFrame(FunctionRef<void(const BlockSegment&, const Ids&)> visit);
  /// At the end of a frame: the block was here in vain.
  void NoteUnused(const BlockWant& block) noexcept;

private:
  struct Retired
  {
    std::uint64_t Fingerprint;
    Ids Blocks;
  };

  Ids ListUsed(const BlockSegment& segment, FunctionRef<Ids()> listCached) const;

  /// Since the last frame.
  std::vector<Retired> Gone;
  std::map<const BlockSegment*, Ids> Wanted;
  /// Blocks of segments that are there.
  std::map<const BlockSegment*, std::unordered_set<BlockId>> Unused;
};

} // namespace dsm

#endif
