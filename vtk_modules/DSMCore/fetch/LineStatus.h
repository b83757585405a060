// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_LineStatus_h
#define dsm_LineStatus_h

#include "DSMCore/base/Error.h"

#include <atomic>
#include <cstdint>
#include <string>

namespace dsm
{

/// State of a block as seen from one rank. Object and page based memory use the same states, for
/// this rank's blocks that their source can bring again and for blocks of other ranks. No state
/// exists for a block that is being evicted: it is absent, and may be requested again, while its
/// old memory waits for the last reader (BlockCache).
enum class LineState : std::uint8_t
{
  Absent,   ///< not here, and not requested
  Foreseen, ///< likely to be needed; no worker waits for it, and no read has begun
  Wanted,   ///< a worker waits for it; no memory to read it yet
  Pending,  ///< its source, or a worker from it, reads it; memory is set aside for it
  Cached,   ///< here, and may be evicted
  Zeroed,   ///< pages of zeros stand in for it until the end of a frame that was cancelled
  Owned,    ///< here for good
  Shared,   ///< a rank of this host owns it, and its memory is mapped here
  Replica   ///< a copy is on this host, until the store that replicates hands the block over
};

/// Use of a block as known to the cache: CLOCK's reference bit, and a third state.
enum class BlockUse : std::uint8_t
{
  Idle,      ///< not used since the clock's hand passed
  Recent,    ///< used since
  Prefetched ///< not used yet; also before it is here
};

/// Status of a block for the handling of misses; under the store's lock.
struct LineStatus
{
  /// Workers that wait for the block, or were woken and are not on their way with it yet: while there
  /// are any, it is not evicted, so even a cache of one block serves them all.
  std::uint16_t Waiters = 0;
  /// Object based, also set by workers that find it other than Recent, without the lock; always Recent
  /// for blocks that are here for good, so that a hit never writes there. Page based, only Prefetched
  /// or not: whether the block was used is then told by its hint (PageHint).
  std::atomic<BlockUse> Use{ BlockUse::Idle };
  LineState State = LineState::Absent;

  /// Returns whether the block can be read.
  bool IsHere() const
  {
    return this->State == LineState::Cached || this->State == LineState::Owned ||
      this->State == LineState::Shared || this->State == LineState::Replica;
  }

  /// Throws Error when there is no way from the present state to `next`.
  void MoveTo(LineState next)
  {
    if (!this->MayMoveTo(next))
    {
      throw Error("A block cannot change from state " +
        std::to_string(static_cast<int>(this->State)) + " to " +
        std::to_string(static_cast<int>(next)) + ". This is a bug in the program.");
    }
    this->State = next;
  }

private:
  bool MayMoveTo(LineState next) const
  {
    switch (this->State)
    {
      case LineState::Absent:
        return next != LineState::Absent && next != LineState::Cached;
      case LineState::Foreseen:
        return next == LineState::Wanted || next == LineState::Pending || next == LineState::Absent;
      case LineState::Wanted:
        return next == LineState::Pending || next == LineState::Absent;
      case LineState::Pending:
        return next == LineState::Cached || next == LineState::Absent;
      case LineState::Cached:
      case LineState::Zeroed:
      case LineState::Replica:
        return next == LineState::Absent;
      default:
        return false;
    }
  }
};

} // namespace dsm

#endif
