// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_PageHint_h
#define dsm_PageHint_h

#include <cstdint>

namespace dsm
{

/// Hint that a worker reads before it touches the pages of a block. It occupies the low bits of the
/// block's entry, which are free because an address is a multiple of the page size. With it a
/// worker waits without a fault, and the clock knows which blocks are in use. Pages may be evicted
/// at any moment, and then fault.
enum class PageHint : std::uintptr_t
{
  Absent = 0,
  Recent = 1,    ///< here, and used since the clock's hand passed
  Idle = 2,      ///< here, not used since
  Prefetched = 4 ///< here, not used yet
};

} // namespace dsm

#endif
