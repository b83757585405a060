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

/// What a frame will probably need of blocks that have just left memory: those of a segment that another
/// like it has taken the place of since the last frame, as a time step does of the one before, and those
/// whose contents have changed. Each rank knows its own. Under the store's lock; nothing here fails: for
/// want of memory less is expected.
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
