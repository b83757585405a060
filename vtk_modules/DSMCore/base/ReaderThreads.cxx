// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/ReaderThreads.h"

#include "DSMCore/base/Error.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

namespace dsm
{

namespace
{

/// They wait for disks more than they compute.
constexpr int FewestThreads = 4;
constexpr int MostThreads = 8;

} // namespace

ReaderThreads& ReaderThreads::GetShared()
{
  static ReaderThreads threads(
    std::clamp(static_cast<int>(std::thread::hardware_concurrency()), FewestThreads, MostThreads));
  return threads;
}

ReaderThreads::ReaderThreads(int count)
  : Count(count)
{
}

ReaderThreads::~ReaderThreads()
{
  this->Stop();
}

void ReaderThreads::Stop()
{
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    this->IsOver = true;
    this->Jobs.clear();
  }
  this->Changed.notify_all();
  for (std::thread& thread : this->Threads)
  {
    thread.join();
  }
  this->Threads.clear();
}

void ReaderThreads::Add(std::function<void()> job)
{
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    if (this->IsOver)
    {
      return;
    }
    try
    {
      while (static_cast<int>(this->Threads.size()) < this->Count)
      {
        this->Threads.emplace_back([this] { this->Run(); });
      }
    }
    catch (const std::system_error& error)
    {
      if (this->Threads.empty())
      {
        throw Error(std::string("Cannot start a thread to read files (") + error.what() +
          "). Raise the process's limit of threads (ulimit -u) or free memory.");
      }
    }
    this->Jobs.push_back(std::move(job));
  }
  this->Changed.notify_one();
}

void ReaderThreads::Run()
{
  std::unique_lock<std::mutex> lock(this->Guard);
  for (;;)
  {
    this->Changed.wait(lock, [this] { return this->IsOver || !this->Jobs.empty(); });
    if (this->IsOver)
    {
      return;
    }
    {
      const std::function<void()> job = std::move(this->Jobs.front());
      this->Jobs.pop_front();
      lock.unlock();
      job();
    }
    lock.lock();
  }
}

} // namespace dsm
