// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockLine_h
#define dsm_BlockLine_h

#include "DSMCore/base/Error.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

namespace dsm
{

/// Where a block stands, seen from one rank.
enum class LineState : std::uint8_t
{
  Absent,   ///< another rank owns it, and nobody here asked for it
  Foreseen, ///< likely to be needed; nobody waits for it, and the request is not sent
  Wanted,   ///< a worker waits for it; the request is not sent, for want of memory
  Pending,  ///< requested from its owner; memory is set aside for it
  Cached,   ///< a copy is here, and may be evicted
  Owned,    ///< here for good
  Shared,   ///< a rank of this host owns it, and its memory is mapped here
  Replica   ///< a copy is on this host, until the store that replicates hands the block over
};

/// What the cache knows of a block's use; CLOCK's reference bit, and a third state.
enum class BlockUse : std::uint8_t
{
  Idle,      ///< not used since the clock's hand passed
  Recent,    ///< used since
  Prefetched ///< nobody has used it yet; before it is here, too
};

/// One entry of a segment's table. The tracing threads read Address on every access and set
/// Use when they find it other than Recent; all else belongs to the miss path, under the store's lock.
/// Sixteen bytes, so that four entries share a cache line.
struct BlockLine
{
  /// Null in the first four states. Stored with release order when the bytes are complete.
  std::atomic<const std::byte*> Address{ nullptr };
  std::uint32_t Bytes = 0;
  /// Workers that wait for the block, or were woken and did not take their pin yet: while there are
  /// any, the block is not evicted, so even a cache of one block serves them all.
  std::uint16_t Waiters = 0;
  /// Always Recent for blocks that are here for good, so that a hit never writes there.
  std::atomic<BlockUse> Use{ BlockUse::Idle };
  LineState State = LineState::Absent;

  /// Throws Error when there is no way from the present state to `next`.
  void MoveTo(LineState next)
  {
    const LineState now = this->State;
    const bool legal = (now == LineState::Absent && next == LineState::Wanted) ||
      (now == LineState::Absent && next == LineState::Foreseen) ||
      (now == LineState::Foreseen && next == LineState::Wanted) ||
      (now == LineState::Foreseen && next == LineState::Pending) ||
      (now == LineState::Foreseen && next == LineState::Absent) ||
      (now == LineState::Absent && next == LineState::Owned) ||
      (now == LineState::Absent && next == LineState::Shared) ||
      (now == LineState::Absent && next == LineState::Replica) ||
      (now == LineState::Replica && next == LineState::Absent) ||
      (now == LineState::Wanted && next == LineState::Pending) ||
      (now == LineState::Wanted && next == LineState::Absent) ||
      (now == LineState::Pending && next == LineState::Cached) ||
      (now == LineState::Pending && next == LineState::Absent) ||
      (now == LineState::Cached && next == LineState::Absent);
    if (!legal)
    {
      throw Error("A block cannot go from state " + std::to_string(static_cast<int>(now)) + " to " +
        std::to_string(static_cast<int>(next)) + ". This is a defect of the program.");
    }
    this->State = next;
  }
};

static_assert(sizeof(BlockLine) == 16, "four lines to a cache line");

} // namespace dsm

#endif
