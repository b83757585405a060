// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WorkerPool_h
#define rt_WorkerPool_h

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace rt
{

/// The tracing threads of a rank; they sleep between frames.
class WorkerPool
{
public:
  WorkerPool() = default;
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Makes `count` threads call `task(index)` once each, index in [0, count), and returns at once;
  /// each that is through, and no longer counts as running, calls `finished`. Neither may throw.
  /// The former run must be over (Wait). Throws dsm::Error, having started none, when the system gives no more threads.
  void Start(int count, std::function<void(int)> task, std::function<void()> finished);

  /// Any thread: how many are still at work. One that is not may be calling `finished` yet.
  int GetRunning() const;

  /// Returns the processor time of the threads so far, in all runs. For the thread that calls Start.
  double GetProcessorSeconds();

  /// Waits until all have returned from `finished`, too: then nothing of the run is used any more.
  void Wait();

private:
  void Loop(int index);

  mutable std::mutex Mutex;
  std::condition_variable Begun;
  std::condition_variable Ended;
  std::vector<std::thread> Threads;
  std::function<void(int)> Task;
  std::function<void()> Finished;
  std::uint64_t Run = 0;
  int Count = 0;
  int Running = 0; ///< that are in Task
  int Engaged = 0; ///< that are in Task or in Finished
  bool Stopping = false;
};

} // namespace rt

#endif
