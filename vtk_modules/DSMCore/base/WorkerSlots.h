// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_WorkerSlots_h
#define dsm_WorkerSlots_h

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace dsm
{

/// How many of a rank's workers run at a time. There may be more workers than that: while one waits
/// for a block it gives its slot to another, so that a miss costs no core (the paper hides misses by
/// several threads for each processor, section 3). A worker whose block has come goes before those
/// that would begin something new.
///
/// Any thread, except where it says otherwise.
class WorkerSlots
{
public:
  /// Between frames: from now on `slots` workers run at a time, at least 1.
  void BeginFrame(int slots);

  /// Waits for a slot, to begin something new.
  void Take();
  /// Gives the slot to a worker that waits for one.
  void Give();
  /// Waits for a slot, to continue interrupted work.
  void Resume();
  /// Call between two pieces of work: gives the slot to workers that want to resume, and takes another one.
  void LetOthersResume();

  /// The time that slots were free in this frame, while any was taken later; summed over the slots.
  std::uint64_t GetIdleNanoseconds() const;

  /// Takes a slot as long as it is in scope.
  class Hold
  {
  public:
    explicit Hold(WorkerSlots& slots)
      : Slots(slots)
    {
      this->Slots.Take();
    }
    ~Hold() { this->Slots.Give(); }
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

  private:
    WorkerSlots& Slots;
  };

private:
  using Clock = std::chrono::steady_clock;

  /// Under the lock, before Free changes.
  void CountIdleTime();

  mutable std::mutex Guard;
  std::condition_variable ForNew;
  std::condition_variable ForBegun;
  int Free = 1;
  int Resuming = 0; ///< workers in Resume that have no slot yet
  Clock::time_point Since;
  Clock::duration Idle{ 0 };
};

/// Throws Error for a number of threads that a rank cannot trace with.
void CheckWorkerCount(int count);

/// A worker's wait for `ready`, which `lock` guards; without a slot meanwhile, where there are slots.
/// `then` is called, with the lock, when it is ready; the wait for a slot comes after, and whether it is
/// still ready when the worker is back is for the caller to see to.
template <class Ready, class Then = void (*)()>
void WaitWithoutSlot(
  WorkerSlots* slots, std::unique_lock<std::mutex>& lock, std::condition_variable& woken,
  Ready ready, Then then = [] {})
{
  if (slots)
  {
    slots->Give();
  }
  woken.wait(lock, ready);
  then();
  if (slots)
  {
    lock.unlock(); // those that have the slots may need it to come to an end
    slots->Resume();
    lock.lock();
  }
}

} // namespace dsm

#endif
