// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_test_FailingCalls_h
#define dsm_test_FailingCalls_h

/// Makes what a process asks of the system fail, as it does when memory is short. The whole test
/// program makes these calls through FailingCalls.cxx.
namespace dsm_test
{

enum class Call
{
  Allocate,        ///< operator new
  AllocateAligned, ///< operator new for more than the usual alignment
  Protect,         ///< mprotect, to make pages readable
  FillPages        ///< ioctl of userfaultfd that fills pages
};

/// While it is in scope, the next call of a kind fails, once. Of any thread, or of those only that have
/// not said that they are spared. One at a time.
class FailingCall
{
public:
  enum class Of
  {
    AnyThread,
    ThreadsNotSpared
  };
  explicit FailingCall(Call call, Of threads = Of::AnyThread);
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
