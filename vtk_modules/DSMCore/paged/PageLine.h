// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PageLine_h
#define dsm_PageLine_h

#include "DSMCore/base/Error.h"

#include <cstdint>
#include <string>

namespace dsm
{

/// Where the pages of a block stand, seen from one rank.
enum class PageState : std::uint8_t
{
  Absent,   ///< another rank owns it, and nobody here asked for it
  Foreseen, ///< likely to be needed; nobody waits for it, and the request is not sent
  Wanted,   ///< a worker waits for it; the request is not sent, for want of memory
  Pending,  ///< requested from its owner; memory is set aside for it
  Cached,   ///< a copy is here, and may be evicted
  Zeroed,   ///< stands in for it until the end of a frame that was cancelled
  Owned     ///< here for good
};

/// What a page store keeps of a block, for the way of a miss: under the store's lock.
struct PageLine
{
  PageState State = PageState::Absent;
  /// Workers that wait for the block, or were woken and are not on their way with it yet: while
  /// there are any, it is not evicted.
  std::uint16_t Waiters = 0;
  /// Was foreseen, and nobody has waited for it. When it is here, its hint tells whether it was used.
  bool IsPrefetched = false;

  /// Throws Error when there is no way from the present state to `next`.
  void MoveTo(PageState next)
  {
    const PageState now = this->State;
    const bool legal = (now == PageState::Absent && next == PageState::Wanted) ||
      (now == PageState::Absent && next == PageState::Foreseen) ||
      (now == PageState::Foreseen && next == PageState::Wanted) ||
      (now == PageState::Foreseen && next == PageState::Pending) ||
      (now == PageState::Foreseen && next == PageState::Absent) ||
      (now == PageState::Absent && next == PageState::Owned) ||
      (now == PageState::Absent && next == PageState::Zeroed) ||
      (now == PageState::Wanted && next == PageState::Pending) ||
      (now == PageState::Wanted && next == PageState::Absent) ||
      (now == PageState::Pending && next == PageState::Cached) ||
      (now == PageState::Pending && next == PageState::Absent) ||
      (now == PageState::Cached && next == PageState::Absent) ||
      (now == PageState::Zeroed && next == PageState::Absent);
    if (!legal)
    {
      throw Error("The pages of a block cannot go from state " +
        std::to_string(static_cast<int>(now)) + " to " + std::to_string(static_cast<int>(next)) +
        ". This is a defect of the program.");
    }
    this->State = next;
  }
};

/// What a worker reads of a block before it touches its pages, in the low bits of the block's entry
/// (which are free, an address being a multiple of the page size). A hint: to wait without a fault,
/// and to tell the clock which blocks are in use. Pages may go at any moment, and then fault.
enum class PageHint : std::uintptr_t
{
  Absent = 0,
  Recent = 1,    ///< here, and used since the clock's hand passed
  Idle = 2,      ///< here, not used since
  Prefetched = 4 ///< here, not used yet
};

} // namespace dsm

#endif
