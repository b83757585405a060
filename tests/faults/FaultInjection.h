// SPDX-License-Identifier: BSD-3-Clause
#ifndef FaultInjection_h
#define FaultInjection_h

#include <atomic>

/// Lets the n-th thing that a rank asks of the system fail: memory (`new`, aligned or not), a mapping
/// (mmap), a page's protection (mprotect), a thread, or a message (FailingTransport). FaultInjection.cxx
/// stands in for those calls in the executable that it is linked into.
class FaultInjection
{
public:
  enum class Kind
  {
    Memory,
    Mapping,
    Protection,
    Thread,
    Message
  };

  /// What a rank asks for of this kind from now on is counted, by the calling thread and those that it
  /// starts meanwhile; `calls` calls succeed, the one behind them fails, all further ones succeed.
  void Arm(Kind kind, long calls);
  /// Nothing fails any more, and nothing is counted. Whether the call came that was to fail.
  bool Disarm();
  /// Called since Arm.
  long GetCalls() const { return this->Calls; }

  /// The calling thread, and those that it starts from now on, belong to this rank.
  void Join();
  /// The calling thread belongs to no rank.
  static void Leave();

  /// Whether the call of the calling thread that is under way is the one that fails.
  static bool Strikes(Kind kind);

private:
  std::atomic<bool> Armed{ false };
  std::atomic<Kind> Counted{ Kind::Memory };
  std::atomic<long> Calls{ 0 };
  std::atomic<long> Target{ 0 };
};

#endif
