// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/MovingDetail.h"

#include <algorithm>

namespace rt
{

namespace
{

/// Time that a try may take in addition to that of a picture that waits for nothing.
constexpr double WaitingSeconds = 0.05;
/// From one look at the store's counters to the next.
constexpr std::chrono::milliseconds LookInterval(2);

} // namespace

std::vector<int> MovingDetail::GetTries(int coarser) const
{
  const bool rises = this->MayRise && this->IsOdd && this->Level > 1 && this->Level <= coarser;
  std::vector<int> tries{ rises ? this->Level - 1 : 0 };
  for (int level = std::min(this->Level, std::max(coarser, 1)); level <= coarser; ++level)
  {
    tries.push_back(level);
  }
  return tries;
}

void MovingDetail::Begin()
{
  this->Start = Clock::now();
  this->NextLook = this->Start +
    std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(WaitingSeconds + this->Seconds));
}

bool MovingDetail::IsTooLong(dsm::BlockStore& store)
{
  const Clock::time_point now = Clock::now();
  if (now < this->NextLook)
  {
    return false;
  }
  this->NextLook = now + LookInterval;
  return store.GetCounters().Workers.Misses > 0;
}

void MovingDetail::Note(int level, std::int64_t misses, double seconds)
{
  if (misses == 0)
  {
    this->Seconds = seconds;
  }
  this->Level = level > 0 ? level : this->Level;
  this->MayRise = level > 0 && misses == 0;
  this->IsOdd = level > 0 && !this->IsOdd;
}

} // namespace rt
