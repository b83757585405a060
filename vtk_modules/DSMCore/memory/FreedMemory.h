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
  /// The same, and again a second later on a separate thread: when data are removed, their users release
  /// their own memory after this code, and nothing calls it then.
  static void ReturnNowAndSoon();
};

} // namespace dsm

#endif
