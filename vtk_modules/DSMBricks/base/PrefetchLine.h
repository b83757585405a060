// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PrefetchLine_h
#define bricks_PrefetchLine_h

namespace bricks
{

/// Hints the processor to load a line of memory that is read soon. The address may be any. Always inlined, as functions
/// must be that do nothing else but call this: GCC 12 takes them for pure ones, and leaves the calls out.
[[gnu::always_inline]] inline void PrefetchLine(const void* address)
{
#if defined(__GNUC__)
  __builtin_prefetch(address);
#else
  (void)address;
#endif
}

} // namespace bricks

#endif
