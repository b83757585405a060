// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_PointLocks_h
#define bricks_PointLocks_h

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

namespace bricks
{

/// A lock of one byte for each point, for what takes nanoseconds: several threads add to records of points. One locked
/// operation takes as long as the atomic addition of one number, and a record has several.
class PointLocks
{
public:
  explicit PointLocks(std::size_t points)
    : Locks(points)
  {
  }

  /// Runs `step`, which does not throw, while no other thread runs one for the same point.
  template <class Step>
  void Run(std::uint64_t point, const Step& step)
  {
    std::atomic<std::uint8_t>& lock = this->Locks[point];
    while (lock.exchange(1, std::memory_order_acquire) != 0)
    {
      std::this_thread::yield();
    }
    step();
    lock.store(0, std::memory_order_release);
  }

private:
  std::vector<std::atomic<std::uint8_t>> Locks;
};

/// Raises a number that several threads raise at the same time.
template <class Number, class Raise>
inline void RaiseAtomic(std::atomic<Number>& number, const Raise& raise)
{
  Number known = number.load(std::memory_order_relaxed);
  for (Number raised = raise(known); raised != known; raised = raise(known))
  {
    if (number.compare_exchange_weak(known, raised, std::memory_order_relaxed))
    {
      return;
    }
  }
}

} // namespace bricks

#endif
