// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/fetch/FetchWorkers.h"

#include <algorithm>

namespace dsm
{

void FetchWorkers::BeginFrame()
{
  for (const auto& worker : this->Workers)
  {
    worker->Slow = WorkerCounters{};
    worker->Accesses.store(0, std::memory_order_relaxed);
  }
}

void FetchWorkers::EndFrame()
{
  this->Last.clear();
  for (const auto& worker : this->Workers)
  {
    this->Last.push_back(Count(*worker));
  }
}

std::vector<WorkerCounters> FetchWorkers::GetCounters(bool isInFrame) const
{
  if (!isInFrame)
  {
    return this->Last;
  }
  std::vector<WorkerCounters> counters;
  for (const auto& worker : this->Workers)
  {
    counters.push_back(Count(*worker));
  }
  return counters;
}

WorkerCounters FetchWorkers::Count(const FetchWorker& worker)
{
  WorkerCounters counter = worker.Slow;
  counter.Accesses = worker.Accesses.load(std::memory_order_relaxed);
  // A miss may be counted ahead of its access, and one access may miss several times, when its block
  // is evicted while it is read.
  counter.Hits = counter.Accesses - std::min(counter.Accesses, counter.Misses);
  return counter;
}

void FetchWorkers::WakeAll() const
{
  for (const auto& worker : this->Workers)
  {
    worker->Woken.notify_one();
  }
}

void FetchWorkers::WakeThoseThatWaitFor(const LineStatus& line) const
{
  for (const auto& worker : this->Workers)
  {
    if (worker->WaitsFor[0] == &line || worker->WaitsFor[1] == &line)
    {
      worker->Woken.notify_one();
    }
  }
}

} // namespace dsm
