// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FreedMemory_h
#define dsm_FreedMemory_h

namespace dsm
{

/// Memory that this process has freed, and that its allocator keeps where many small blocks were. Any thread; throws
/// nothing.
class FreedMemory
{
public:
  /// Gives it back to the system; takes milliseconds.
  static void Return();
  /// The same, and once more a second later, on a thread of its own: when data go, those who showed them let go of
  /// what they had beside them after us, and nobody calls us then.
  static void ReturnNowAndSoon();
};

} // namespace dsm

#endif
