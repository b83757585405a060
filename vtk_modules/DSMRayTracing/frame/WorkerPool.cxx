// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/WorkerPool.h"

#include "DSMCore/base/Error.h"

#include <pthread.h>
#include <time.h>

#include <string>
#include <system_error>

namespace rt
{

WorkerPool::~WorkerPool()
{
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Stopping = true;
  }
  this->Begun.notify_all();
  for (std::thread& thread : this->Threads)
  {
    thread.join();
  }
}

void WorkerPool::Start(int count, std::function<void(int)> task, std::function<void()> finished)
{
  try
  {
    while (static_cast<int>(this->Threads.size()) < count)
    {
      const int index = static_cast<int>(this->Threads.size());
      this->Threads.emplace_back([this, index] { this->Loop(index); });
    }
  }
  catch (const std::system_error& error)
  {
    throw dsm::Error("Only " + std::to_string(this->Threads.size()) + " of " +
      std::to_string(count) + " tracing threads started (" + error.what() +
      "). Lower the number of threads (DSMThreads).");
  }
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Task = std::move(task);
    this->Finished = std::move(finished);
    this->Count = count;
    this->Running = count;
    this->Engaged = count;
    ++this->Run;
  }
  this->Begun.notify_all();
}

int WorkerPool::GetRunning() const
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->Running;
}

double WorkerPool::GetProcessorSeconds()
{
  double seconds = 0.0;
  for (std::thread& thread : this->Threads)
  {
    clockid_t clock{};
    timespec time{};
    if (pthread_getcpuclockid(thread.native_handle(), &clock) == 0 &&
      clock_gettime(clock, &time) == 0)
    {
      seconds += static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }
  }
  return seconds;
}

void WorkerPool::Wait()
{
  std::unique_lock<std::mutex> lock(this->Mutex);
  this->Ended.wait(lock, [this] { return this->Engaged == 0; });
}

void WorkerPool::Loop(int index)
{
  std::uint64_t seen = 0;
  std::unique_lock<std::mutex> lock(this->Mutex);
  for (;;)
  {
    this->Begun.wait(lock, [&] { return this->Stopping || this->Run != seen; });
    if (this->Stopping)
    {
      return;
    }
    seen = this->Run;
    // Threads beyond the count of this run sit it out.
    if (index >= this->Count)
    {
      continue;
    }
    lock.unlock();
    this->Task(index);
    lock.lock();
    --this->Running;
    lock.unlock();
    this->Finished(); // sees that this one has stopped, and is over before Wait returns
    lock.lock();
    if (--this->Engaged == 0)
    {
      this->Ended.notify_all();
    }
  }
}

} // namespace rt
