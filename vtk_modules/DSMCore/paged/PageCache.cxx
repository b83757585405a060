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

void PageCache::PrepareSlot()
{
  if (this->EmptySlots.empty())
  {
    if (this->EmptySlots.capacity() <= this->Slots.size())
    {
      this->EmptySlots.reserve(2 * this->Slots.size() + 1); // all may become empty
    }
    this->Slots.emplace_back();
    this->EmptySlots.push_back(this->Slots.size() - 1);
  }
}

void PageCache::Insert(const Slot& slot)
{
  this->PrepareSlot();
  this->Slots[this->EmptySlots.back()] = slot;
  this->EmptySlots.pop_back();
}

PageCache::Slot PageCache::TakeOut(std::size_t index)
{
  const Slot slot = this->Slots[index];
  this->EmptySlots.push_back(index);
  this->Slots[index] = Slot{};
  this->Used -= slot.Footprint;
  return slot;
}

bool PageCache::TryEvict(Time before, Slot& evicted)
{
  // In the first round the hand clears the reference bits, so the second finds all there is.
  for (std::size_t step = 0; step < 2 * this->Slots.size(); ++step)
  {
    this->Hand = this->Hand + 1 < this->Slots.size() ? this->Hand + 1 : 0;
    Slot& slot = this->Slots[this->Hand];
    if (!slot.From || slot.Placed > before || slot.From->Lines[slot.Id].Waiters > 0)
    {
      continue;
    }
    bool wasUnused = false;
    if (!slot.From->IsPure)
    {
      const PageHint hint = slot.From->GetHint(slot.Id);
      wasUnused = hint == PageHint::Prefetched;
      if (hint == PageHint::Recent)
      {
        slot.From->SetHint(slot.Id, PageHint::Idle);
        continue;
      }
      if (wasUnused && !std::exchange(slot.IsSpared, true))
      {
        continue;
      }
      // A worker that finds it idle right now may be about to mark it again; it will fault.
      slot.From->SetHint(slot.Id, PageHint::Absent);
    }
    evicted = this->TakeOut(this->Hand);
    evicted.WasUnused = wasUnused;
    return true;
  }
  return false;
}

std::vector<BlockId> PageCache::List(const PagedStore::Segment& segment) const
{
  std::vector<BlockId> blocks;
  for (const Slot& slot : this->Slots)
  {
    if (slot.From == &segment)
    {
      blocks.push_back(slot.Id);
    }
  }
  return blocks;
}

void PageCache::Forget(const PagedStore::Segment& segment,
  const std::function<void(const Slot&)>& visit, const std::vector<bool>* which)
{
  for (std::size_t index = 0; index < this->Slots.size(); ++index)
  {
    const Slot& slot = this->Slots[index];
    if (slot.From == &segment && (!which || (*which)[slot.Id]))
    {
      visit(this->TakeOut(index));
    }
  }
}

} // namespace dsm
