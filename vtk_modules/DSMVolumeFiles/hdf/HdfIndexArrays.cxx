// SPDX-License-Identifier: BSD-3-Clause
// The arrays in which HDF5 keeps where chunks are: entries that are found by a chunk's number.
#include "DSMVolumeFiles/hdf/HdfChunkIndex.h"

#include <algorithm>

namespace vol
{

namespace
{

/// Before what a block of either array has of its own: signature, version, what it is for, and its header's address.
constexpr std::size_t PrefixBytes = 4 + 1 + 1 + HdfBytes::Address;

bool IsPowerOfTwo(std::uint64_t number)
{
  return number > 0 && (number & (number - 1)) == 0;
}

int GetLog2(std::uint64_t number)
{
  int log = 0;
  while (number >>= 1)
  {
    ++log;
  }
  return log;
}

/// "HDF5 File Format Specification", VII.D, and H5EAhdr.c of the library for how the blocks grow.
class ExtensibleArray
{
public:
  ExtensibleArray(HdfChunkIndex& reader, const HdfBytes& header)
    : Reader(reader)
    , EntryBytes(header.Get(6, 1))
    , CountBits(header.Get(7, 1))
    , InIndex(header.Get(8, 1))
    , LeastEntries(header.Get(9, 1))
    , LeastPointers(header.Get(10, 1))
    , PageBits(header.Get(11, 1))
    , Index(header.Get(60, HdfBytes::Address))
  {
    this->IsRight = HdfChunkIndex::IsEntry(header.Get(5, 1) == 1, this->EntryBytes) &&
      header.Get(5, 1) <= 1 && this->CountBits <= 64 && this->PageBits < 32 &&
      IsPowerOfTwo(this->LeastEntries) && IsPowerOfTwo(this->LeastPointers) &&
      this->CountBits >= static_cast<std::uint64_t>(GetLog2(this->LeastEntries));
    this->OffsetBytes = static_cast<std::size_t>((this->CountBits + 7) / 8);
  }

  bool Read()
  {
    if (!this->IsRight || this->Index == HdfUndefined)
    {
      return this->IsRight;
    }
    const int superBlocks = 1 + static_cast<int>(this->CountBits) - GetLog2(this->LeastEntries);
    // The first super blocks are not stored: the index leads to their data blocks.
    const int direct = std::min(superBlocks, 2 * GetLog2(this->LeastPointers));
    const std::uint64_t pointers = 2 * (this->LeastPointers - 1);
    const std::size_t entries = PrefixBytes + this->InIndex * this->EntryBytes;
    const std::size_t superPointers = entries + pointers * HdfBytes::Address;
    const auto index = this->Reader.ReadChecked(this->Index,
      superPointers + static_cast<std::size_t>(superBlocks - direct) * HdfBytes::Address +
        HdfBytes::Checksum,
      "EAIB");
    if (!index || !this->Reader.AddEntries(*index, PrefixBytes, this->EntryBytes, 0, this->InIndex))
    {
      return false;
    }
    std::uint64_t number = this->InIndex;
    std::uint64_t block = 0;
    for (int super = 0; super < superBlocks; ++super)
    {
      const std::uint64_t blocks = std::uint64_t(1) << (super / 2);
      const std::uint64_t blockEntries = this->LeastEntries << ((super + 1) / 2);
      if (super < direct)
      {
        for (std::uint64_t at = 0; at < blocks; ++at, ++block)
        {
          if (block >= pointers ||
            !this->ReadBlock(index->Get(entries + block * HdfBytes::Address, HdfBytes::Address),
              blockEntries, number + at * blockEntries))
          {
            return false;
          }
        }
      }
      else
      {
        const std::size_t place =
          superPointers + static_cast<std::size_t>(super - direct) * HdfBytes::Address;
        if (!this->ReadSuperBlock(
              index->Get(place, HdfBytes::Address), blocks, blockEntries, number))
        {
          return false;
        }
      }
      number += blocks * blockEntries;
    }
    return true;
  }

private:
  std::uint64_t GetPages(std::uint64_t entries) const
  {
    const std::uint64_t page = std::uint64_t(1) << this->PageBits;
    return entries > page ? entries / page : 0;
  }

  bool ReadSuperBlock(
    std::uint64_t address, std::uint64_t blocks, std::uint64_t blockEntries, std::uint64_t number)
  {
    if (address == HdfUndefined)
    {
      return true;
    }
    // A bit for each page of the data blocks: whether it is there.
    constexpr std::uint64_t most = std::uint64_t(1) << 32; // far more than a block is read of
    const std::uint64_t pages = this->GetPages(blockEntries);
    if (blocks > most || pages > most)
    {
      return false;
    }
    const std::size_t bits = PrefixBytes + this->OffsetBytes;
    const std::uint64_t bitBytes = blocks * ((pages + 7) / 8);
    const auto block = this->Reader.ReadChecked(
      address, bits + bitBytes + blocks * HdfBytes::Address + HdfBytes::Checksum, "EASB");
    if (!block)
    {
      return false;
    }
    for (std::uint64_t at = 0; at < blocks; ++at)
    {
      const std::uint64_t data =
        block->Get(bits + bitBytes + at * HdfBytes::Address, HdfBytes::Address);
      const std::uint64_t first = number + at * blockEntries;
      if (pages == 0
          ? !this->ReadBlock(data, blockEntries, first)
          : !this->ReadPages(data, pages, first,
              [&](std::uint64_t page) { return block->GetBit(bits, at * pages + page); }))
      {
        return false;
      }
    }
    return true;
  }

  bool ReadBlock(std::uint64_t address, std::uint64_t entries, std::uint64_t number)
  {
    if (address == HdfUndefined)
    {
      return true;
    }
    if (this->GetPages(entries) != 0)
    {
      return false;
    }
    const std::size_t before = PrefixBytes + this->OffsetBytes;
    const auto block = this->Reader.ReadChecked(
      address, before + entries * this->EntryBytes + HdfBytes::Checksum, "EADB");
    return block && this->Reader.AddEntries(*block, before, this->EntryBytes, number, entries);
  }

  bool ReadPages(std::uint64_t address, std::uint64_t pages, std::uint64_t number,
    const dsm::FunctionRef<bool(std::uint64_t page)>& isThere)
  {
    const std::uint64_t entries = std::uint64_t(1) << this->PageBits;
    const std::uint64_t before = PrefixBytes + this->OffsetBytes + HdfBytes::Checksum;
    return address == HdfUndefined ||
      (this->Reader.ReadChecked(address, before, "EADB") &&
        this->Reader.AddPages(
          address + before, entries, this->EntryBytes, number, pages * entries, isThere));
  }

  HdfChunkIndex& Reader;
  std::size_t EntryBytes;
  std::uint64_t CountBits;     ///< of the number of an entry
  std::uint64_t InIndex;       ///< entries in the index block
  std::uint64_t LeastEntries;  ///< of a data block
  std::uint64_t LeastPointers; ///< to data blocks, of a super block
  std::uint64_t PageBits;
  std::uint64_t Index;
  std::size_t OffsetBytes = 0;
  bool IsRight = false;
};

} // namespace

bool HdfChunkIndex::ReadExtensibleArray(std::uint64_t address)
{
  const std::optional<HdfBytes> header = this->ReadChecked(address, 72, "EAHD");
  return header && ExtensibleArray(*this, *header).Read();
}

/// "HDF5 File Format Specification", VII.C.
bool HdfChunkIndex::ReadFixedArray(std::uint64_t address)
{
  const std::optional<HdfBytes> header = this->ReadChecked(address, 28, "FAHD");
  if (!header)
  {
    return false;
  }
  const std::size_t entryBytes = header->Get(6, 1);
  const std::uint64_t pageBits = header->Get(7, 1);
  const std::uint64_t count = header->Get(8, 8);
  const std::uint64_t block = header->Get(16, HdfBytes::Address);
  if (header->Get(5, 1) > 1 || !IsEntry(header->Get(5, 1) == 1, entryBytes) || pageBits > 31 ||
    count > this->CountMost().value_or(0))
  {
    return false;
  }
  if (block == HdfUndefined)
  {
    return true;
  }
  const std::uint64_t pageEntries = std::uint64_t(1) << pageBits;
  if (count <= pageEntries)
  {
    const auto entries =
      this->ReadChecked(block, PrefixBytes + count * entryBytes + HdfBytes::Checksum, "FADB");
    return entries && this->AddEntries(*entries, PrefixBytes, entryBytes, 0, count);
  }
  // A bit for each page: whether it is there.
  const std::uint64_t pages = (count - 1) / pageEntries + 1;
  const std::uint64_t before = PrefixBytes + (pages + 7) / 8 + HdfBytes::Checksum;
  const auto bits = this->ReadChecked(block, before, "FADB");
  return bits &&
    this->AddPages(block + before, pageEntries, entryBytes, 0, count,
      [&](std::uint64_t page) { return bits->GetBit(PrefixBytes, page); });
}

} // namespace vol
