// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_StoreWorkers_h
#define dsm_StoreWorkers_h

#include "DSMCore/base/Counters.h"
#include "DSMCore/base/Error.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace dsm
{

/// Throws Error for a number of threads that a rank cannot trace with.
inline void CheckWorkerCount(int count)
{
  if (count < 1 || count > std::numeric_limits<std::uint16_t>::max())
  {
    throw Error("A rank cannot trace with " + std::to_string(count) +
      " threads. Set the number of threads (DSMThreads) to 0 for an automatic choice, or to at "
      "least 1.");
  }
}

/// The workers of a store that fetches blocks, and what they count. A Worker has Accesses (atomic, its
/// own thread's), Slow (WorkerCounters), Woken (a condition) and WaitsFor (the line it waits for). The
/// store's lock is held for every call but Get.
template <class Worker>
class StoreWorkers
{
public:
  /// Workers that stay keep their addresses.
  void Resize(int count)
  {
    this->Workers.resize(static_cast<std::size_t>(count));
    for (auto& worker : this->Workers)
    {
      if (!worker)
      {
        worker = std::make_unique<Worker>();
      }
    }
  }

  Worker& Get(int index) const { return *this->Workers.at(static_cast<std::size_t>(index)); }

  auto begin() const { return this->Workers.begin(); }
  auto end() const { return this->Workers.end(); }

  void BeginFrame()
  {
    for (const auto& worker : this->Workers)
    {
      worker->Slow = WorkerCounters{};
      worker->Accesses.store(0, std::memory_order_relaxed);
    }
  }

  /// Workers may come and go afterwards: the counters are those of the frame.
  void EndFrame() { this->Last = this->Count(); }

  /// Of the frame, or of the last one.
  std::vector<WorkerCounters> GetCounters(bool isInFrame) const
  {
    return isInFrame ? this->Count() : this->Last;
  }

  void WakeAll() const
  {
    for (const auto& worker : this->Workers)
    {
      worker->Woken.notify_one();
    }
  }

  template <class Line>
  void WakeThoseThatWaitFor(const Line& line) const
  {
    for (const auto& worker : this->Workers)
    {
      if (worker->WaitsFor == &line)
      {
        worker->Woken.notify_one();
      }
    }
  }

private:
  std::vector<WorkerCounters> Count() const
  {
    std::vector<WorkerCounters> counters;
    for (const auto& worker : this->Workers)
    {
      WorkerCounters counter = worker->Slow;
      counter.Accesses = worker->Accesses.load(std::memory_order_relaxed);
      // A miss may be counted ahead of its access, and one access may miss several times, when its
      // block is evicted while it is read.
      counter.Hits = counter.Accesses - std::min(counter.Accesses, counter.Misses);
      counters.push_back(counter);
    }
    return counters;
  }

  std::vector<std::unique_ptr<Worker>> Workers;
  std::vector<WorkerCounters> Last;
};

} // namespace dsm

#endif
