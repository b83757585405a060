// SPDX-License-Identifier: BSD-3-Clause
#include "DSMVolumeFiles/hdf/HdfChunkIndex.h"

#include "DSMVolumeFiles/base/FileLimits.h"

#include <algorithm>
#include <numeric>

namespace vol
{

namespace
{

constexpr std::size_t MaskBytes = 4;

} // namespace

HdfChunkIndex::HdfChunkIndex(const PositionedFile& file, const HdfChunkLayout& layout,
  const std::vector<std::uint64_t>& most, const Visit& visit)
  : File(file)
  , Tell(visit)
  , Edges(layout.Edges.begin(), layout.Edges.end() - 1)
  , Most(most)
  , Order(most.size())
  , Place(most.size())
  , Left(file.GetBytes())
  , PlainBytes(static_cast<std::uint32_t>(MultiplyWithin(UINT32_MAX, layout.Edges).value_or(0)))
{
  std::iota(this->Order.begin(), this->Order.end(), std::size_t(0));
  for (std::size_t axis = 0; axis < most.size(); ++axis)
  {
    if (most[axis] == UINT64_MAX)
    {
      std::rotate(this->Order.begin(), this->Order.begin() + static_cast<std::ptrdiff_t>(axis),
        this->Order.begin() + static_cast<std::ptrdiff_t>(axis) + 1);
    }
    else
    {
      this->Most[axis] =
        most[axis] / this->Edges[axis] + (most[axis] % this->Edges[axis] != 0 ? 1 : 0);
    }
  }
}

bool HdfChunkIndex::Read(const PositionedFile& file, const HdfChunkLayout& layout,
  const std::vector<std::uint64_t>& most, const Visit& visit)
{
  using Index = HdfChunkLayout::Index;
  if (layout.Edges.size() != most.size() + 1 ||
    std::find(layout.Edges.begin(), layout.Edges.end(), 0u) != layout.Edges.end())
  {
    return false;
  }
  if (layout.Address == HdfUndefined)
  {
    return true; // no chunk has been written
  }
  HdfChunkIndex reader(file, layout, most, visit);
  if (layout.Kind != Index::Tree1 && !layout.IsFiltered && reader.PlainBytes == 0)
  {
    return false;
  }
  switch (layout.Kind)
  {
    case Index::Tree1:
      return reader.ReadTree1(layout.Address);
    case Index::Single:
      return reader.AddNumbered(0,
        { layout.Address,
          layout.IsFiltered
            ? static_cast<std::uint32_t>(std::min<std::uint64_t>(layout.SingleBytes, UINT32_MAX))
            : reader.PlainBytes,
          layout.SingleSkippedFilters });
    case Index::Implicit:
      return reader.ReadImplicit(layout.Address);
    case Index::FixedArray:
      return reader.ReadFixedArray(layout.Address);
    case Index::ExtensibleArray:
      return reader.ReadExtensibleArray(layout.Address);
    case Index::Tree2:
      return reader.ReadTree2(layout.Address);
  }
  return false;
}

bool HdfChunkIndex::Spend(std::uint64_t count)
{
  const bool isLeft = count <= this->Left;
  this->Left -= isLeft ? count : 0;
  return isLeft;
}

std::optional<HdfBytes> HdfChunkIndex::Read(std::uint64_t offset, std::uint64_t count)
{
  return this->Spend(count) ? HdfBytes::Read(this->File, offset, count) : std::nullopt;
}

std::optional<HdfBytes> HdfChunkIndex::ReadChecked(
  std::uint64_t offset, std::uint64_t count, const char* signature)
{
  return this->Spend(count) ? HdfBytes::ReadChecked(this->File, offset, count, signature)
                            : std::nullopt;
}

bool HdfChunkIndex::Add(const std::uint64_t* place, const HdfChunk& chunk)
{
  const std::uint64_t bytes = this->File.GetBytes();
  return chunk.First <= bytes && chunk.Bytes <= bytes - chunk.First && this->Tell(place, chunk);
}

bool HdfChunkIndex::AddNumbered(std::uint64_t number, const HdfChunk& chunk)
{
  for (std::size_t at = this->Order.size(); at-- > 1;)
  {
    const std::size_t axis = this->Order[at];
    const std::uint64_t along = this->Most[axis];
    if (along == 0 || along == UINT64_MAX)
    {
      return false; // chunks have no numbers if two axes grow without a limit
    }
    this->Place[axis] = number % along;
    number /= along;
  }
  this->Place[this->Order.front()] = number;
  return number < this->Most[this->Order.front()] && this->Add(this->Place.data(), chunk);
}

std::optional<std::uint64_t> HdfChunkIndex::CountMost() const
{
  return MultiplyWithin(FileLimits::ArrayBytes, this->Most);
}

bool HdfChunkIndex::IsEntry(bool isFiltered, std::uint64_t entryBytes)
{
  constexpr std::size_t least = HdfBytes::Address + 1 + MaskBytes;
  constexpr std::size_t most = HdfBytes::Address + 8 + MaskBytes;
  return isFiltered ? entryBytes >= least && entryBytes <= most : entryBytes == HdfBytes::Address;
}

HdfChunk HdfChunkIndex::GetChunk(
  const HdfBytes& block, std::size_t place, std::size_t entryBytes) const
{
  HdfChunk chunk{ block.Get(place, HdfBytes::Address), this->PlainBytes, 0 };
  if (entryBytes > HdfBytes::Address)
  {
    const std::size_t sizeBytes = entryBytes - HdfBytes::Address - MaskBytes;
    const std::uint64_t bytes = block.Get(place + HdfBytes::Address, sizeBytes);
    chunk.Bytes = static_cast<std::uint32_t>(std::min<std::uint64_t>(bytes, UINT32_MAX));
    chunk.SkippedFilters =
      static_cast<std::uint32_t>(block.Get(place + HdfBytes::Address + sizeBytes, MaskBytes));
  }
  return chunk;
}

bool HdfChunkIndex::AddEntries(const HdfBytes& block, std::size_t place, std::size_t entryBytes,
  std::uint64_t number, std::uint64_t count)
{
  for (std::uint64_t entry = 0; entry < count; ++entry, place += entryBytes)
  {
    const HdfChunk chunk = this->GetChunk(block, place, entryBytes);
    if (chunk.First != HdfUndefined && !this->AddNumbered(number + entry, chunk))
    {
      return false;
    }
  }
  return true;
}

bool HdfChunkIndex::AddPages(std::uint64_t address, std::uint64_t pageEntries,
  std::size_t entryBytes, std::uint64_t number, std::uint64_t count,
  const dsm::FunctionRef<bool(std::uint64_t page)>& isThere)
{
  const std::uint64_t pageBytes = pageEntries * entryBytes + HdfBytes::Checksum;
  for (std::uint64_t first = 0; first < count; first += pageEntries, address += pageBytes)
  {
    if (!isThere(first / pageEntries))
    {
      continue;
    }
    const std::uint64_t entries = std::min(pageEntries, count - first);
    const auto page = this->Read(address, entries * entryBytes + HdfBytes::Checksum);
    if (!page || !page->HasRightChecksum() ||
      !this->AddEntries(*page, 0, entryBytes, number + first, entries))
    {
      return false;
    }
  }
  return true;
}

bool HdfChunkIndex::ReadTree1(std::uint64_t address)
{
  return this->ReadNode1(address, -1);
}

bool HdfChunkIndex::ReadNode1(std::uint64_t address, int level)
{
  constexpr std::size_t start = 24;
  constexpr int mostLevels = 32;
  const std::optional<HdfBytes> head = this->Read(address, start);
  if (!head || !head->Begins("TREE") || head->Get(4, 1) != 1)
  {
    return false;
  }
  const int own = static_cast<int>(head->Get(5, 1));
  if (own > mostLevels || (level >= 0 && own != level))
  {
    return false;
  }
  const std::size_t axes = this->GetAxes();
  const std::size_t keyBytes = 8 + 8 * (axes + 1);
  const std::size_t step = keyBytes + HdfBytes::Address;
  const std::uint64_t children = head->Get(6, 2);
  const std::optional<HdfBytes> list = this->Read(address + start, children * step);
  if (!list)
  {
    return false;
  }
  for (std::size_t key = 0; key < list->GetCount(); key += step)
  {
    const std::uint64_t child = list->Get(key + keyBytes, HdfBytes::Address);
    if (own > 0)
    {
      if (!this->ReadNode1(child, own - 1))
      {
        return false;
      }
      continue;
    }
    for (std::size_t axis = 0; axis < axes; ++axis)
    {
      const std::uint64_t first = list->Get(key + 8 + 8 * axis, 8);
      this->Place[axis] = first / this->Edges[axis];
      if (first % this->Edges[axis] != 0)
      {
        return false;
      }
    }
    const HdfChunk chunk{ child, static_cast<std::uint32_t>(list->Get(key, 4)),
      static_cast<std::uint32_t>(list->Get(key + 4, 4)) };
    if (!this->Add(this->Place.data(), chunk))
    {
      return false;
    }
  }
  return true;
}

bool HdfChunkIndex::ReadImplicit(std::uint64_t address)
{
  const std::optional<std::uint64_t> count = this->CountMost();
  if (!count || this->PlainBytes == 0 || address > this->File.GetBytes() ||
    *count > (this->File.GetBytes() - address) / this->PlainBytes)
  {
    return false;
  }
  for (std::uint64_t number = 0; number < *count; ++number)
  {
    if (!this->AddNumbered(number, { address + number * this->PlainBytes, this->PlainBytes, 0 }))
    {
      return false;
    }
  }
  return true;
}

} // namespace vol
