// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfChunkTable.h"

#include <algorithm>

namespace vol
{

void HdfChunkTable::Reserve(std::uint64_t count)
{
  constexpr std::uint64_t most = 1 << 20; // the count may be wrong
  this->Entries.reserve(static_cast<std::size_t>(std::min(count, most)));
}

void HdfChunkTable::Add(std::uint64_t number, const HdfChunk& chunk)
{
  this->IsSorted =
    this->Entries.empty() || (this->IsSorted && this->Entries.back().Number < number);
  this->Entries.push_back({ number, chunk });
}

bool HdfChunkTable::Sort()
{
  if (this->Entries.size() < this->Entries.capacity() / 2)
  {
    this->Entries.shrink_to_fit();
  }
  if (this->IsSorted)
  {
    return true;
  }
  std::sort(this->Entries.begin(), this->Entries.end(),
    [](const Entry& a, const Entry& b) { return a.Number < b.Number; });
  this->IsSorted =
    std::adjacent_find(this->Entries.begin(), this->Entries.end(),
      [](const Entry& a, const Entry& b) { return a.Number == b.Number; }) == this->Entries.end();
  return this->IsSorted;
}

const HdfChunk* HdfChunkTable::Find(std::uint64_t number) const
{
  // If all chunks are present, each is at its own number.
  const auto begin = this->Entries.begin();
  const std::size_t last = this->Entries.size();
  if (number < last && this->Entries[number].Number == number)
  {
    return &this->Entries[number].Chunk;
  }
  const auto found = std::lower_bound(begin,
    begin + static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(number, last)), number,
    [](const Entry& entry, std::uint64_t wanted) { return entry.Number < wanted; });
  return found != this->Entries.end() && found->Number == number ? &found->Chunk : nullptr;
}

std::uint64_t HdfChunkTable::GetBytes() const
{
  return this->Entries.size() * sizeof(Entry);
}

void HdfChunkTable::AddFilterInFront()
{
  for (Entry& entry : this->Entries)
  {
    entry.Chunk.SkippedFilters <<= 1;
  }
}

} // namespace vol
