// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_FailingCalls_h
#define dsm_test_FailingCalls_h

/// Makes what a process asks of the system fail, as it does when memory is short. The whole test
/// program makes these calls through FailingCalls.cxx.
namespace dsm_test
{

enum class Call
{
  Allocate,     ///< operator new
  AllocateMuch, ///< operator new for LargeBytes or more: no message that ranks agree by
  Map,          ///< mmap, of memory that is no file's
  FillPages     ///< ioctl of userfaultfd that fills pages
};

constexpr unsigned long LargeBytes = 4096;

/// While it is in scope, the next call of a kind, or the one after `passed` others, fails, once. Of any
/// thread, of the one that says so, or of those only that have not said that they are spared. One at a
/// time.
class FailingCall
{
public:
  enum class Of
  {
    AnyThread,
    ThisThread,
    ThreadsNotSpared
  };
  explicit FailingCall(Call call, Of threads = Of::AnyThread, int passed = 0);
  ~FailingCall();
  FailingCall(const FailingCall&) = delete;
  FailingCall& operator=(const FailingCall&) = delete;

  /// Whether it has failed.
  static bool HasHappened();
  /// The calling thread does not fail from now on, where threads are told apart.
  static void SpareThisThread();
};

} // namespace dsm_test

#endif
