// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/BlockCache.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace dsm
{

bool BlockCache::TryReserve(std::size_t blockBytes)
{
  const std::size_t footprint = GetBlockFootprint(blockBytes);
  if (this->Used + footprint > this->Capacity)
  {
    return false;
  }
  this->Used += footprint;
  this->Peak = std::max(this->Peak, this->Used);
  return true;
}

void BlockCache::Release(std::size_t blockBytes)
{
  this->Used -= GetBlockFootprint(blockBytes);
}

void BlockCache::PrepareSlot()
{
  // With room for all slots at any time, so that to fill and to empty one cannot fail.
  if (this->Slots.capacity() == this->Slots.size())
  {
    this->Slots.reserve(2 * (this->Slots.size() + 1));
  }
  this->EmptySlots.reserve(this->Slots.capacity());
}

void BlockCache::Insert(BlockLine& line, BlockMemory memory)
{
  if (this->EmptySlots.empty())
  {
    this->Slots.emplace_back();
    this->EmptySlots.push_back(this->Slots.size() - 1);
  }
  const std::byte* const address = memory.get();
  Slot& slot = this->Slots[this->EmptySlots.back()];
  slot.Line = &line;
  slot.Memory = std::move(memory);
  slot.Footprint = GetBlockFootprint(line.Bytes);
  this->EmptySlots.pop_back();
  line.MoveTo(LineState::Cached);
  if (line.Use.load(std::memory_order_relaxed) != BlockUse::Prefetched)
  {
    line.Use.store(BlockUse::Idle, std::memory_order_relaxed);
  }
  line.Address.store(address, std::memory_order_release);
}

BlockCache::Evictions BlockCache::Evict(
  std::size_t blockBytes, std::size_t spareBytes, std::uint64_t epoch)
{
  const std::size_t needed = GetBlockFootprint(blockBytes) + spareBytes;
  Evictions evicted;
  // Twice around: the first time may do no more than clear reference bits.
  for (std::size_t step = 0; step < 2 * this->Slots.size(); ++step)
  {
    if (this->Used - this->LimboBytes + needed <= this->Capacity)
    {
      break;
    }
    const std::size_t slot = this->Hand;
    this->Hand = (this->Hand + 1) % this->Slots.size();
    BlockLine* const line = this->Slots[slot].Line;
    if (!line || line->Waiters > 0)
    {
      continue;
    }
    if (line->Use.load(std::memory_order_relaxed) == BlockUse::Recent)
    {
      line->Use.store(BlockUse::Idle, std::memory_order_relaxed);
      continue;
    }
    const bool isUnused = line->Use.load(std::memory_order_relaxed) == BlockUse::Prefetched;
    if (isUnused && !std::exchange(this->Slots[slot].IsSpared, true))
    {
      continue;
    }
    const BlockUse use = line->Use.exchange(BlockUse::Idle, std::memory_order_relaxed);
    evicted.Unused += use == BlockUse::Prefetched ? 1 : 0;
    ++evicted.Count;
    this->EvictSlot(slot, epoch);
  }
  return evicted;
}

bool BlockCache::Reclaim(std::uint64_t oldestEpoch)
{
  bool any = false;
  while (!this->Limbo.empty() && this->Limbo.front().Epoch <= oldestEpoch)
  {
    this->Used -= this->Limbo.front().Footprint;
    this->LimboBytes -= this->Limbo.front().Footprint;
    this->Limbo.pop_front();
    any = true;
  }
  return any;
}

std::vector<BlockId> BlockCache::List(const BlockLine* first, std::size_t count) const
{
  std::vector<BlockId> places;
  for (const Slot& slot : this->Slots)
  {
    if (slot.Line && slot.Line >= first && slot.Line < first + count)
    {
      places.push_back(static_cast<BlockId>(slot.Line - first));
    }
  }
  return places;
}

void BlockCache::Forget(const BlockLine* first, std::size_t count, const std::vector<bool>* which)
{
  this->Reclaim(std::numeric_limits<std::uint64_t>::max());
  for (std::size_t slot = 0; slot < this->Slots.size(); ++slot)
  {
    const BlockLine* const line = this->Slots[slot].Line;
    if (line && line >= first && line < first + count &&
      (!which || (*which)[static_cast<std::size_t>(line - first)]))
    {
      this->Drop(slot);
    }
  }
}

void BlockCache::Shrink()
{
  this->Reclaim(std::numeric_limits<std::uint64_t>::max());
  for (std::size_t step = 0; step < 2 * this->Slots.size(); ++step)
  {
    if (this->Used - this->LimboBytes <= this->Capacity)
    {
      break;
    }
    const std::size_t slot = this->Hand;
    this->Hand = (this->Hand + 1) % this->Slots.size();
    BlockLine* const line = this->Slots[slot].Line;
    if (line && line->Use.exchange(BlockUse::Idle, std::memory_order_relaxed) != BlockUse::Recent)
    {
      this->Drop(slot);
    }
  }
}

void BlockCache::Drop(std::size_t slot)
{
  Slot& taken = this->Slots[slot];
  taken.Line->MoveTo(LineState::Absent);
  taken.Line->Address.store(nullptr, std::memory_order_relaxed);
  this->Used -= taken.Footprint;
  taken = Slot{};
  this->EmptySlots.push_back(slot);
}

void BlockCache::EvictSlot(std::size_t slot, std::uint64_t epoch)
{
  Slot& taken = this->Slots[slot];
  this->Limbo.emplace_back(); // first: it may throw
  Evicted& evicted = this->Limbo.back();
  evicted.Memory = std::move(taken.Memory);
  evicted.Footprint = taken.Footprint;
  evicted.Epoch = epoch;
  taken.Line->MoveTo(LineState::Absent);
  taken.Line->Address.store(nullptr, std::memory_order_relaxed); // ordered by the epoch's release
  this->LimboBytes += taken.Footprint;
  taken = Slot{};
  this->EmptySlots.push_back(slot);
}

} // namespace dsm
