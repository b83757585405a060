// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_FetchWorkers_h
#define dsm_FetchWorkers_h

#include "DSMCore/base/Counters.h"
#include "DSMCore/fetch/LineStatus.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace dsm
{

/// A tracing thread's part of a store that fetches blocks. A store derives its own, on a cache line of
/// its own.
struct FetchWorker
{
  FetchWorker() = default;
  virtual ~FetchWorker() = default;
  FetchWorker(const FetchWorker&) = delete;
  FetchWorker& operator=(const FetchWorker&) = delete;

  /// Only the worker writes (no read-modify-write is needed); atomic, so that the communication
  /// thread may read it while the frame runs.
  std::atomic<std::uint64_t> Accesses{ 0 };

  // Under the store's lock.
  WorkerCounters Slow; ///< all but Accesses and Hits
  /// What the worker waits for: a block, or a pair of them; else null.
  const LineStatus* WaitsFor[2] = {};
  std::condition_variable Woken;
};

/// The workers of a store that fetches blocks, and what they count. The store's lock is held for every
/// call but Get.
class FetchWorkers
{
public:
  /// Workers that stay keep their addresses.
  template <class Worker>
  void Resize(int count)
  {
    this->Workers.resize(static_cast<std::size_t>(count));
    this->Last.reserve(this->Workers.size());
    for (auto& worker : this->Workers)
    {
      worker = worker ? std::move(worker) : std::make_unique<Worker>();
    }
  }

  FetchWorker& Get(int index) const { return *this->Workers.at(static_cast<std::size_t>(index)); }
  auto begin() const { return this->Workers.begin(); }
  auto end() const { return this->Workers.end(); }

  void BeginFrame();
  /// Workers may come and go afterwards: the counters are those of the frame. Needs no memory.
  void EndFrame();
  /// Returns the counters of each worker, for the current frame or for the last one.
  std::vector<WorkerCounters> GetCounters(bool isInFrame) const;

  void WakeAll() const;
  void WakeThoseThatWaitFor(const LineStatus& line) const;

private:
  static WorkerCounters Count(const FetchWorker& worker);

  std::vector<std::unique_ptr<FetchWorker>> Workers;
  std::vector<WorkerCounters> Last;
};

} // namespace dsm

#endif
