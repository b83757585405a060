// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/FreedMemory.h"

#include "DSMCore/memory/BlockHeap.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

#ifdef __GLIBC__ // which the headers above tell
#include <malloc.h>
#endif

namespace dsm
{

namespace
{

constexpr std::chrono::seconds Soon(1);

/// Returns memory when it was last asked to a while ago. Its thread ends then, or with the process.
class Delay
{
public:
  ~Delay()
  {
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      this->IsOver = true;
    }
    this->Changed.notify_all();
    if (this->Thread.joinable())
    {
      this->Thread.join();
    }
  }

  void Ask()
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    this->Due = Clock::now() + Soon;
    if (this->IsWaiting)
    {
      return;
    }
    if (this->Thread.joinable())
    {
      this->Thread.join(); // it has nothing left to do
    }
    try
    {
      this->Thread = std::thread([this] { this->Wait(); });
      this->IsWaiting = true;
    }
    catch (const std::system_error&) // no thread can be had: then it stays until the next time
    {
    }
  }

private:
  using Clock = std::chrono::steady_clock;

  void Wait()
  {
    std::unique_lock<std::mutex> lock(this->Guard);
    while (!this->IsOver && Clock::now() < this->Due)
    {
      this->Changed.wait_until(lock, this->Due);
    }
    if (!this->IsOver)
    {
      FreedMemory::Return();
    }
    this->IsWaiting = false;
  }

  std::mutex Guard;
  std::condition_variable Changed;
  std::thread Thread;
  Clock::time_point Due;
  bool IsWaiting = false; ///< the thread, for Due
  bool IsOver = false;
};

} // namespace

void FreedMemory::Return()
{
  BlockHeap::GetShared().ReturnFreePages();
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void FreedMemory::ReturnNowAndSoon()
{
  static Delay delay;
  Return();
  delay.Ask();
}

} // namespace dsm
