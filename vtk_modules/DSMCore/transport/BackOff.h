// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_BackOff_h
#define dsm_BackOff_h

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace dsm
{

/// How a thread waits for messages, which nothing announces. It polls a few times (an answer within the host takes
/// microseconds), then gives its core away between polls, then sleeps, ever longer, so that it does not starve the
/// tracing threads of its host. A sleep takes many times as long as a message does: threads that wait for one
/// another in turn would spend their time in it. So while no thread traces, they give their cores away for longer
/// first.
class BackOff
{
public:
  enum class Patience
  {
    Short,
    Long ///< longer than it takes another thread to wake up
  };

  /// Something happened, or a wait begins: the next wait is short again. The waiting thread.
  void Reset(Patience patience = Patience::Short);
  /// Nothing happened: waits a little more than the last time, until WakeUp at most. The waiting
  /// thread.
  void Wait();
  /// Any thread: ends the wait, or the next one. Cheap while no thread sleeps.
  void WakeUp();

private:
  static constexpr int Polls = 8;
  static constexpr int Yields = 32;
  static constexpr std::chrono::microseconds LongYields{ 500 };
  static constexpr std::chrono::microseconds ShortestSleep{ 20 };
  static constexpr std::chrono::microseconds LongestSleep{ 200 };

  bool MayYield();

  Patience Holds = Patience::Short;
  int Idle = 0;
  std::chrono::steady_clock::time_point Since; ///< when Idle was 0, of a long patience
  std::chrono::microseconds Sleep = ShortestSleep;
  std::mutex Guard;
  std::condition_variable Condition;
  std::atomic<bool> Sleeping{ false };
  std::atomic<bool> Woken{ false };
};

} // namespace dsm

#endif
