// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PrefetchLine_h
#define bricks_PrefetchLine_h

namespace bricks
{

/// Hints the processor to load a line of memory that is read soon. The address may be any.
inline void PrefetchLine(const void* address)
{
#if defined(__GNUC__)
  __builtin_prefetch(address);
#else
  (void)address;
#endif
}

} // namespace bricks

#endif
