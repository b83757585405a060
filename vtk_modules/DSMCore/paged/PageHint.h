// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PageHint_h
#define dsm_PageHint_h

#include <cstdint>

namespace dsm
{

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
