// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/paged/PageCache.h"

#include <algorithm>
#include <utility>

namespace dsm
{

bool PageCache::TryReserve(std::size_t footprint)
{
  if (this->Used + footprint > this->Capacity)
  {
    return false;
  }
  this->Used += footprint;
  this->Peak = std::max(this->Peak, this->Used);
  return true;
}

void PageCache::Insert(const Frame& frame)
{
  if (this->EmptySlots.empty())
  {
    this->Frames.push_back(frame);
    return;
  }
  this->Frames[this->EmptySlots.back()] = frame;
  this->EmptySlots.pop_back();
}

PageCache::Frame PageCache::TakeOut(std::size_t slot)
{
  const Frame frame = this->Frames[slot];
  this->EmptySlots.push_back(slot);
  this->Frames[slot] = Frame{};
  this->Used -= frame.Footprint;
  return frame;
}

bool PageCache::TryEvict(
  Time before, const std::function<bool(const Frame&)>& mayGo, Frame& evicted)
{
  // In the first round the hand clears the reference bits, so the second finds all there is.
  for (std::size_t step = 0; step < 2 * this->Frames.size(); ++step)
  {
    this->Hand = this->Hand + 1 < this->Frames.size() ? this->Hand + 1 : 0;
    Frame& frame = this->Frames[this->Hand];
    if (!frame.From || frame.Placed > before || frame.From->Lines[frame.Id].Waiters > 0 ||
      (mayGo && !mayGo(frame)))
    {
      continue;
    }
    bool wasUnused = false;
    if (!frame.From->IsPure)
    {
      const PageHint hint = frame.From->GetHint(frame.Id);
      wasUnused = hint == PageHint::Prefetched;
      if (hint == PageHint::Recent)
      {
        frame.From->SetHint(frame.Id, PageHint::Idle);
        continue;
      }
      if (wasUnused && !std::exchange(frame.IsSpared, true))
      {
        continue;
      }
      // A worker that finds it idle right now may be about to mark it again; it will fault.
      frame.From->SetHint(frame.Id, PageHint::Absent);
    }
    evicted = this->TakeOut(this->Hand);
    evicted.WasUnused = wasUnused;
    return true;
  }
  return false;
}

std::vector<PageCache::Frame> PageCache::Forget(const PagedStore::Segment& segment)
{
  std::vector<Frame> forgotten;
  for (std::size_t slot = 0; slot < this->Frames.size(); ++slot)
  {
    if (this->Frames[slot].From == &segment)
    {
      forgotten.push_back(this->TakeOut(slot));
    }
  }
  return forgotten;
}

} // namespace dsm
