// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/base/WorkerSlots.h"

#include "DSMCore/base/Error.h"

#include <limits>
#include <string>

namespace dsm
{

void WorkerSlots::BeginFrame(int slots)
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->Free = slots;
  this->Since = Clock::now();
  this->Idle = Clock::duration(0);
}

void WorkerSlots::CountIdleTime()
{
  const auto now = Clock::now();
  this->Idle += this->Free * (now - this->Since);
  this->Since = now;
}

void WorkerSlots::Take()
{
  std::unique_lock<std::mutex> lock(this->Guard);
  this->ForNew.wait(lock, [this] { return this->Free > this->Resuming; });
  this->CountIdleTime();
  --this->Free;
}

void WorkerSlots::Give()
{
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    this->CountIdleTime();
    ++this->Free;
    if (this->Resuming >= this->Free)
    {
      this->ForBegun.notify_one();
      return;
    }
  }
  this->ForNew.notify_one();
}

void WorkerSlots::Resume()
{
  std::unique_lock<std::mutex> lock(this->Guard);
  ++this->Resuming;
  this->ForBegun.wait(lock, [this] { return this->Free > 0; });
  --this->Resuming;
  this->CountIdleTime();
  --this->Free;
}

void WorkerSlots::LetOthersResume()
{
  std::unique_lock<std::mutex> lock(this->Guard);
  if (this->Resuming == 0)
  {
    return;
  }
  this->CountIdleTime();
  ++this->Free;
  this->ForBegun.notify_one();
  this->ForNew.wait(lock, [this] { return this->Free > this->Resuming; });
  this->CountIdleTime();
  --this->Free;
}

std::uint64_t WorkerSlots::GetIdleNanoseconds() const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return static_cast<std::uint64_t>(
    std::chrono::duration_cast<std::chrono::nanoseconds>(this->Idle).count());
}

void CheckWorkerCount(int count)
{
  if (count < 1 || count > std::numeric_limits<std::uint16_t>::max())
  {
    throw Error("DSMThreads: " + std::to_string(count) +
      " is not a valid number of threads. Use 0 (automatic) or at least 1.");
  }
}

} // namespace dsm
