// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ConcurrentFragmentSource_h
#define dsm_ConcurrentFragmentSource_h

#include "DSMCore/publish/Publication.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace dsm
{

/// Runs several sources, a thread each, ahead of the one that publishes; for sources that compute or convert what
/// they yield. At most `Ahead` fragments wait at any time. Next rethrows the exceptions of sources, and throws if a
/// thread cannot be started, so that the publication fails on all ranks.
class ConcurrentFragmentSource final : public FragmentSource
{
public:
  /// The sources must not share state. Their threads start at once.
  explicit ConcurrentFragmentSource(std::vector<std::unique_ptr<FragmentSource>> sources);
  ~ConcurrentFragmentSource() override;

  bool Next(Fragment& fragment) override;
  double GetProgress() const override;

private:
  static constexpr std::size_t Ahead = 16;

  /// Ends the threads; the first failure is the one that Next throws.
  void Stop(std::exception_ptr failure);
  void Produce(FragmentSource& source, std::atomic<double>& progress);

  std::vector<std::unique_ptr<FragmentSource>> Sources;
  std::vector<std::atomic<double>> Progress; ///< by source, from 0 on
  std::mutex Mutex;
  std::condition_variable Changed;
  std::deque<Fragment> Waiting;
  std::size_t Producing;
  bool Stopping = false;
  std::exception_ptr Failure;
  std::vector<std::thread> Threads;
};

} // namespace dsm

#endif
