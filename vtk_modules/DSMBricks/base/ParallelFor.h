// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_ParallelFor_h
#define bricks_ParallelFor_h

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace bricks
{

/// Calls function(index, thread) for every index below `count`, on the calling thread and
/// `threads - 1` others, in any order; returns when all calls have. Rethrows the first exception;
/// indices not begun by then are left out.
template <class Function>
void ParallelFor(int threads, std::size_t count, const Function& function)
{
  std::atomic<std::size_t> next{ 0 };
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&](int thread)
  {
    try
    {
      for (std::size_t index = next++; index < count; index = next++)
      {
        function(index, thread);
      }
    }
    catch (...)
    {
      next = count;
      const std::lock_guard<std::mutex> lock(mutex);
      failure = failure ? failure : std::current_exception();
    }
  };
  std::vector<std::thread> helpers;
  for (int thread = 1; thread < threads && static_cast<std::size_t>(thread) < count; ++thread)
  {
    try
    {
      helpers.emplace_back(work, thread);
    }
    catch (const std::exception&)
    {
      break; // fewer threads do the same
    }
  }
  work(0);
  for (std::thread& helper : helpers)
  {
    helper.join();
  }
  if (failure)
  {
    std::rethrow_exception(failure);
  }
}

/// ParallelFor over [0, count) in chunks: function(begin, end, chunk, thread).
template <class Function>
void ParallelForChunks(
  int threads, std::size_t count, std::size_t chunkSize, const Function& function)
{
  ParallelFor(threads, (count + chunkSize - 1) / chunkSize,
    [&](std::size_t chunk, int thread)
    {
      const std::size_t begin = chunk * chunkSize;
      function(begin, begin + chunkSize < count ? begin + chunkSize : count, chunk, thread);
    });
}

} // namespace bricks

#endif
