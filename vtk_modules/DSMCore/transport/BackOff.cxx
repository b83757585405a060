// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/transport/BackOff.h"

#include <algorithm>
#include <thread>

namespace dsm
{

void BackOff::Reset(Patience patience)
{
  this->Holds = patience;
  this->Idle = 0;
  this->Sleep = ShortestSleep;
}

bool BackOff::MayYield()
{
  if (this->Holds == Patience::Short)
  {
    return this->Idle < Polls + Yields;
  }
  const auto now = std::chrono::steady_clock::now();
  this->Since = this->Idle == Polls ? now : this->Since;
  return now - this->Since < LongYields;
}

void BackOff::Wait()
{
  if (this->Idle < Polls)
  {
    ++this->Idle;
    return;
  }
  if (this->MayYield())
  {
    ++this->Idle;
    std::this_thread::yield();
    return;
  }
  std::unique_lock<std::mutex> lock(this->Guard);
  this->Sleeping = true;
  this->Condition.wait_for(lock, this->Sleep, [this] { return this->Woken.load(); });
  this->Sleeping = false;
  if (this->Woken.exchange(false))
  {
    this->Reset(this->Holds);
  }
  else
  {
    this->Sleep = std::min(2 * this->Sleep, LongestSleep);
  }
}

void BackOff::WakeUp()
{
  // Both flags are sequentially consistent: either the sleeper sees Woken before it sleeps, or this
  // thread sees Sleeping and notifies; the lock keeps the notice from falling between the sleeper's
  // look at Woken and its sleep.
  this->Woken = true;
  if (this->Sleeping)
  {
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
    }
    this->Condition.notify_one();
  }
}

} // namespace dsm
