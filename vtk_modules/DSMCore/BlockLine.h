// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockLine_h
#define dsm_BlockLine_h

#include "DSMCore/Error.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

namespace dsm
{

/// Where a block stands, seen from one rank.
enum class LineState : std::uint8_t
{
  Absent,  ///< another rank owns it, and nobody here asked for it
  Wanted,  ///< a worker waits for it; the request is not sent, for want of memory
  Pending, ///< requested from its owner; memory is set aside for it
  Cached,  ///< a copy is here, and may be evicted
  Owned,   ///< here for good
  Shared,  ///< a rank of this host owns it, and its memory is mapped here
  Replica  ///< a copy is on this host, until the store that replicates hands the block over
};

/// One entry of a segment's table. The tracing threads read Address on every access and set
/// Referenced when they find it unset; all else belongs to the miss path, under the store's lock.
/// Sixteen bytes, so that four entries share a cache line.
struct BlockLine
{
  /// Null in the first three states. Stored with release order when the bytes are complete.
  std::atomic<const std::byte*> Address{ nullptr };
  std::uint32_t Bytes = 0;
  /// Workers that wait for the block, or were woken and did not take their pin yet: while there are
  /// any, the block is not evicted, so even a cache of one block serves them all.
  std::uint16_t Waiters = 0;
  /// The reference bit of CLOCK. Always set for blocks that are not cached, so that a hit never
  /// writes there.
  std::atomic<std::uint8_t> Referenced{ 0 };
  LineState State = LineState::Absent;

  /// Throws Error when there is no way from the present state to `next`.
  void MoveTo(LineState next)
  {
    const LineState now = this->State;
    const bool legal = (now == LineState::Absent && next == LineState::Wanted) ||
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
