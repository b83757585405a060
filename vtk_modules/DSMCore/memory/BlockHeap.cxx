// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/memory/BlockHeap.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <new>
#include <utility>

namespace dsm
{

namespace
{

/// An arena is about as large as all before it, so that a small cache takes little.
constexpr std::size_t LeastArena = std::size_t(256) << 10;
constexpr std::size_t LargestArena = std::size_t(64) << 20;
constexpr std::size_t BitsOfWord = 64;
/// At extents that may be too small.
constexpr int MostLooks = 64;

bool GetBit(const std::vector<std::uint64_t>& bits, std::size_t bit)
{
  return (bits[bit / BitsOfWord] >> (bit % BitsOfWord) & 1) != 0;
}

void FlipBit(std::vector<std::uint64_t>& bits, std::size_t bit)
{
  bits[bit / BitsOfWord] ^= std::uint64_t(1) << (bit % BitsOfWord);
}

/// Behind an extent's last byte.
std::size_t& SizeBefore(std::byte* end)
{
  return *reinterpret_cast<std::size_t*>(end - sizeof(std::size_t));
}

} // namespace

BlockHeap& BlockHeap::GetShared()
{
  // Not destroyed: stores of other static objects may outlive it otherwise.
  static auto* const heap = new BlockHeap;
  return *heap;
}

std::size_t BlockHeap::GetList(std::size_t bytes)
{
  std::size_t units = bytes / BlockAlignment;
  std::size_t power = 0;
  for (; units >= 8; units /= 2)
  {
    ++power;
  }
  return std::min(4 * power + units, Lists - 1);
}

std::vector<BlockHeap::Arena>::iterator BlockHeap::FindArenaBehind(const std::byte* memory)
{
  return std::upper_bound(this->Arenas.begin(), this->Arenas.end(), memory,
    [](const std::byte* place, const Arena& arena) { return place < arena.Memory.GetData(); });
}

BlockHeap::Extent* BlockHeap::FindExtent(std::size_t bytes)
{
  // In the list of its own size only some may do; in those behind it any does.
  const std::size_t own = GetList(bytes);
  int looks = 0;
  for (Extent* extent = this->Extents[own]; extent && looks < MostLooks; extent = extent->Next)
  {
    if (extent->Bytes >= bytes)
    {
      return extent;
    }
    ++looks;
  }
  const auto larger = std::find_if(this->Extents.begin() + static_cast<std::ptrdiff_t>(own) + 1,
    this->Extents.end(), [](const Extent* extent) { return extent != nullptr; });
  return larger == this->Extents.end() ? nullptr : *larger;
}

std::byte* BlockHeap::Allocate(std::size_t bytes)
{
  const std::size_t footprint = GetBlockFootprint(bytes);
  const std::lock_guard<std::mutex> lock(this->Guard);
  Extent* extent = this->FindExtent(footprint);
  if (!extent)
  {
    this->AddArena(footprint);
    extent = this->FindExtent(footprint);
  }
  auto* const memory = reinterpret_cast<std::byte*>(extent);
  Arena& arena = this->FindArena(memory);
  const std::size_t rest = extent->Bytes - footprint;
  this->Remove(arena, extent);
  if (rest > 0)
  {
    this->Insert(arena, memory + footprint, rest);
  }
  this->BlockBytes += footprint;
  return memory;
}

void BlockHeap::Free(std::byte* memory, std::size_t bytes) noexcept
{
  std::size_t footprint = GetBlockFootprint(bytes);
  const std::lock_guard<std::mutex> lock(this->Guard);
  this->BlockBytes -= footprint;
  Arena& arena = this->FindArena(memory);
  std::byte* const begin = arena.Memory.GetData();
  const std::size_t units = arena.Memory.GetBytes() / BlockAlignment;
  const auto getUnit = [&](const std::byte* place)
  { return static_cast<std::size_t>(place - begin) / BlockAlignment; };
  const std::size_t next = getUnit(memory + footprint);
  if (next < units && GetBit(arena.Begins, next))
  {
    auto* const behind = reinterpret_cast<Extent*>(memory + footprint);
    footprint += behind->Bytes;
    this->Remove(arena, behind);
  }
  const std::size_t first = getUnit(memory);
  if (first > 0 && GetBit(arena.Ends, first - 1))
  {
    const std::size_t before = SizeBefore(memory);
    memory -= before;
    footprint += before;
    this->Remove(arena, reinterpret_cast<Extent*>(memory));
  }
  if (footprint == units * BlockAlignment)
  {
    this->ArenaBytes -= arena.Memory.GetBytes();
    this->Arenas.erase(this->Arenas.begin() + (&arena - this->Arenas.data()));
    return;
  }
  this->Insert(arena, memory, footprint);
}

void BlockHeap::AddArena(std::size_t bytes)
{
  const std::size_t size = std::max(bytes, std::clamp(this->ArenaBytes, LeastArena, LargestArena));
  Arena arena;
  arena.Memory = BlockArena(AlignBlock(size));
  const std::size_t words =
    (arena.Memory.GetBytes() / BlockAlignment + BitsOfWord - 1) / BitsOfWord;
  arena.Begins.resize(words);
  arena.Ends.resize(words);
  std::byte* const memory = arena.Memory.GetData();
  Arena& added = *this->Arenas.insert(this->FindArenaBehind(memory), std::move(arena));
  this->ArenaBytes += added.Memory.GetBytes();
  this->Insert(added, memory, added.Memory.GetBytes());
}

void BlockHeap::FlipEnds(Arena& arena, const std::byte* memory, std::size_t bytes) noexcept
{
  const auto unit = static_cast<std::size_t>(memory - arena.Memory.GetData()) / BlockAlignment;
  FlipBit(arena.Begins, unit);
  FlipBit(arena.Ends, unit + bytes / BlockAlignment - 1);
}

void BlockHeap::Insert(Arena& arena, std::byte* memory, std::size_t bytes) noexcept
{
  auto* const extent = new (memory) Extent{ bytes, nullptr, nullptr };
  SizeBefore(memory + bytes) = bytes;
  Extent*& head = this->Extents[GetList(bytes)];
  extent->Next = head;
  if (head)
  {
    head->Previous = extent;
  }
  head = extent;
  FlipEnds(arena, memory, bytes);
}

void BlockHeap::Remove(Arena& arena, Extent* extent) noexcept
{
  (extent->Previous ? extent->Previous->Next : this->Extents[GetList(extent->Bytes)]) =
    extent->Next;
  if (extent->Next)
  {
    extent->Next->Previous = extent->Previous;
  }
  FlipEnds(arena, reinterpret_cast<std::byte*>(extent), extent->Bytes);
}

void BlockHeap::ReturnFreePages() noexcept
{
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const std::lock_guard<std::mutex> lock(this->Guard);
  for (Extent* const list : this->Extents)
  {
    for (Extent* extent = list; extent; extent = extent->Next)
    {
      const auto begin = reinterpret_cast<std::uintptr_t>(extent);
      // Pages with what is noted at the two ends stay.
      const std::uintptr_t first = (begin + sizeof(Extent) + page - 1) / page * page;
      const std::uintptr_t last = (begin + extent->Bytes - sizeof(std::size_t)) / page * page;
      if (first < last)
      {
        madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
      }
    }
  }
}

std::size_t BlockHeap::GetBlockBytes() const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->BlockBytes;
}

std::size_t BlockHeap::GetArenaBytes() const
{
  const std::lock_guard<std::mutex> lock(this->Guard);
  return this->ArenaBytes;
}

} // namespace dsm
