// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/store/ScratchBlocks.h"

#include "DSMCore/base/ByteDigest.h"
#include "DSMCore/base/Error.h"

#include <algorithm>

namespace dsm
{

ScratchBlocks::ScratchBlocks(const BlockDirectory& directory, int rank, int ranks)
  : Rank(static_cast<BlockId>(rank))
  , Ranks(static_cast<BlockId>(ranks))
{
  this->Entries.reserve(static_cast<std::size_t>(directory.GetCount() / this->Ranks + 1));
  for (BlockId id = this->Rank; id < directory.GetCount(); id += this->Ranks)
  {
    Entry entry;
    entry.Offset = this->FileBytes;
    entry.Bytes = directory.GetBytes(id);
    this->FileBytes += AlignBlock(entry.Bytes);
    this->Entries.push_back(entry);
  }
}

std::uint64_t ScratchBlocks::CountTableBytes(const BlockDirectory& directory, int ranks)
{
  return (directory.GetCount() / static_cast<BlockId>(ranks) + 1) * sizeof(Entry);
}

void ScratchBlocks::Open(const std::string& directory)
{
  this->File = std::make_unique<ScratchFile>(directory, this->FileBytes);
  this->Slots.resize(MostInMemory);
}

void ScratchBlocks::Write(const Slot& slot)
{
  this->File->Write(this->GetEntry(slot.Id).Offset, slot.Bytes.data(), slot.Bytes.size());
}

std::byte* ScratchBlocks::Load(BlockId id, FragmentSink& sink)
{
  auto slot = std::find_if(this->Slots.begin(), this->Slots.end(),
    [=](const Slot& candidate) { return candidate.LastUse != 0 && candidate.Id == id; });
  if (slot == this->Slots.end())
  {
    slot = std::min_element(this->Slots.begin(), this->Slots.end(),
      [](const Slot& a, const Slot& b) { return a.LastUse < b.LastUse; });
    if (slot->LastUse != 0)
    {
      this->Write(*slot);
      slot->LastUse = 0;
    }
    Entry& entry = this->GetEntry(id);
    slot->Id = id;
    slot->Bytes.assign(entry.Bytes, std::byte{ 0 });
    if (entry.Begun)
    {
      this->File->Read(entry.Offset, slot->Bytes.data(), entry.Bytes);
    }
    else
    {
      sink.Begin(id, slot->Bytes.data(), entry.Bytes);
      entry.Begun = true;
    }
  }
  slot->LastUse = ++this->Uses;
  return slot->Bytes.data();
}

void ScratchBlocks::Absorb(
  BlockId id, const std::byte* fragment, std::size_t bytes, FragmentSink& sink)
{
  sink.Absorb(id, this->Load(id, sink), this->GetEntry(id).Bytes, fragment, bytes);
}

void ScratchBlocks::Finish(FragmentSink& sink, FunctionRef<void(double)> progress)
{
  const std::size_t step = this->Entries.size() / 100 + 1;
  for (std::size_t index = 0; index < this->Entries.size(); ++index)
  {
    const BlockId id = this->Rank + static_cast<BlockId>(index) * this->Ranks;
    Entry& entry = this->Entries[index];
    std::byte* const block = this->Load(id, sink);
    sink.Finish(id, block, entry.Bytes);
    entry.Checksum = HashBytes(block, entry.Bytes, id);
    if (progress && index % step == 0)
    {
      progress(static_cast<double>(index) / static_cast<double>(this->Entries.size()));
    }
  }
  for (const Slot& slot : this->Slots)
  {
    if (slot.LastUse != 0)
    {
      this->Write(slot);
    }
  }
  this->Slots = {};
}

void ScratchBlocks::Read(BlockId id, std::byte* block, std::size_t bytes) const
{
  const Entry& entry = this->Entries[id / this->Ranks];
  this->File->Read(entry.Offset, block, bytes);
  if (HashBytes(block, bytes, id) != entry.Checksum)
  {
    throw Error("Brick " + std::to_string(id) + " in the scratch file in '" +
      this->File->GetDirectory() +
      "' (DSMScratchDirectory) has a wrong checksum. Check the disk, or choose another directory.");
  }
}

bool ScratchBlocks::ReadWithoutWaiting(BlockId id, std::byte* block, std::size_t bytes) const
{
  const Entry& entry = this->Entries[id / this->Ranks];
  const ScratchFile::Attempt attempt = this->CanTell
    ? this->File->TryRead(entry.Offset, block, bytes)
    : ScratchFile::Attempt::CannotTell;
  if (attempt == ScratchFile::Attempt::CannotTell)
  {
    this->CanTell = false;
  }
  return attempt == ScratchFile::Attempt::Done && HashBytes(block, bytes, id) == entry.Checksum;
}

void ScratchBlocks::Prefetch(const std::vector<BlockId>& ids) const
{
  for (const BlockId id : ids)
  {
    const Entry& entry = this->Entries[id / this->Ranks];
    this->File->Prefetch(entry.Offset, entry.Bytes);
  }
}

} // namespace dsm
