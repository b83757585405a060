// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BlockLine_h
#define dsm_BlockLine_h

#include "DSMCore/fetch/LineStatus.h"

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace dsm
{

/// One entry of a segment's table. The tracing threads read Address on every access and set
/// Use when they find it other than Recent; all else belongs to the miss path, under the store's lock.
/// Sixteen bytes, so that four entries share a cache line.
struct BlockLine : LineStatus
{
  std::uint32_t Bytes = 0;
  /// Null as long as the block is not here. Stored with release order when the bytes are complete.
  std::atomic<const std::byte*> Address{ nullptr };
};

static_assert(sizeof(BlockLine) == 16, "four lines to a cache line");

} // namespace dsm

#endif
