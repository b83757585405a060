// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/table/BlockCache.h"

#include "DSMCore/base/Block.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

namespace dsm
{

namespace
{

void Free(std::byte* memory)
{
  ::operator delete(memory, std::align_val_t(BlockAlignment));
}

} // namespace

BlockCache::~BlockCache()
{
  for (const Frame& frame : this->Frames)
  {
    Free(frame.Memory);
  }
  for (const Evicted& evicted : this->Limbo)
  {
    Free(evicted.Memory);
  }
}

std::size_t BlockCache::GetFootprint(std::size_t blockBytes)
{
  return AlignBlock(std::max(blockBytes, std::size_t(1)));
}

bool BlockCache::TryReserve(std::size_t blockBytes)
{
  const std::size_t footprint = GetFootprint(blockBytes);
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
  this->Used -= GetFootprint(blockBytes);
}

void BlockCache::Insert(BlockLine& line, const std::byte* bytes)
{
  if (this->EmptySlots.empty())
  {
    // With room for all slots at any time, so that to empty one cannot fail.
    if (this->EmptySlots.capacity() <= this->Frames.size())
    {
      this->EmptySlots.reserve(2 * this->Frames.size() + 1);
    }
    this->Frames.emplace_back();
    this->EmptySlots.push_back(this->Frames.size() - 1);
  }
  Frame& frame = this->Frames[this->EmptySlots.back()];
  const std::size_t footprint = GetFootprint(line.Bytes);
  auto* const memory =
    static_cast<std::byte*>(::operator new(footprint, std::align_val_t(BlockAlignment)));
  frame = Frame{ &line, memory, footprint };
  this->EmptySlots.pop_back();
  std::copy_n(bytes, line.Bytes, memory);
  line.MoveTo(LineState::Cached);
  if (line.Use.load(std::memory_order_relaxed) != BlockUse::Prefetched)
  {
    line.Use.store(BlockUse::Idle, std::memory_order_relaxed);
  }
  line.Address.store(memory, std::memory_order_release);
}

BlockCache::Evictions BlockCache::Evict(
  std::size_t blockBytes, std::size_t spareBytes, std::uint64_t epoch)
{
  const std::size_t needed = GetFootprint(blockBytes) + spareBytes;
  Evictions evicted;
  // Twice around: the first time may do no more than clear reference bits.
  for (std::size_t step = 0; step < 2 * this->Frames.size(); ++step)
  {
    if (this->Used - this->LimboBytes + needed <= this->Capacity)
    {
      break;
    }
    const std::size_t slot = this->Hand;
    this->Hand = (this->Hand + 1) % this->Frames.size();
    BlockLine* const line = this->Frames[slot].Line;
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
    if (isUnused && !std::exchange(this->Frames[slot].IsSpared, true))
    {
      continue;
    }
    const BlockUse use = line->Use.exchange(BlockUse::Idle, std::memory_order_relaxed);
    evicted.Unused += use == BlockUse::Prefetched ? 1 : 0;
    ++evicted.Count;
    this->EvictFrame(slot, epoch);
  }
  return evicted;
}

bool BlockCache::Reclaim(std::uint64_t oldestEpoch)
{
  bool any = false;
  while (!this->Limbo.empty() && this->Limbo.front().Epoch <= oldestEpoch)
  {
    Free(this->Limbo.front().Memory);
    this->Used -= this->Limbo.front().Footprint;
    this->LimboBytes -= this->Limbo.front().Footprint;
    this->Limbo.pop_front();
    any = true;
  }
  return any;
}

void BlockCache::Forget(const BlockLine* first, std::size_t count)
{
  this->Reclaim(std::numeric_limits<std::uint64_t>::max());
  for (std::size_t slot = 0; slot < this->Frames.size(); ++slot)
  {
    const BlockLine* const line = this->Frames[slot].Line;
    if (line && line >= first && line < first + count)
    {
      this->Drop(slot);
    }
  }
}

void BlockCache::Shrink()
{
  this->Reclaim(std::numeric_limits<std::uint64_t>::max());
  for (std::size_t step = 0; step < 2 * this->Frames.size(); ++step)
  {
    if (this->Used - this->LimboBytes <= this->Capacity)
    {
      break;
    }
    const std::size_t slot = this->Hand;
    this->Hand = (this->Hand + 1) % this->Frames.size();
    BlockLine* const line = this->Frames[slot].Line;
    if (line && line->Use.exchange(BlockUse::Idle, std::memory_order_relaxed) != BlockUse::Recent)
    {
      this->Drop(slot);
    }
  }
}

void BlockCache::Drop(std::size_t slot)
{
  Frame& frame = this->Frames[slot];
  frame.Line->MoveTo(LineState::Absent);
  frame.Line->Address.store(nullptr, std::memory_order_relaxed);
  Free(frame.Memory);
  this->Used -= frame.Footprint;
  frame = Frame{};
  this->EmptySlots.push_back(slot);
}

void BlockCache::EvictFrame(std::size_t slot, std::uint64_t epoch)
{
  Frame& frame = this->Frames[slot];
  this->Limbo.push_back(Evicted{ frame.Memory, frame.Footprint, epoch }); // first: it may throw
  frame.Line->MoveTo(LineState::Absent);
  frame.Line->Address.store(nullptr, std::memory_order_relaxed); // ordered by the epoch's release
  this->LimboBytes += frame.Footprint;
  frame = Frame{};
  this->EmptySlots.push_back(slot);
}

} // namespace dsm
