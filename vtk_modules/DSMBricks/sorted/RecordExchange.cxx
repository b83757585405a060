// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/sorted/RecordExchange.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/memory/BlockArena.h"
#include "DSMCore/publish/SegmentPublisher.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

namespace bricks
{

namespace
{

/// Bytes of records in one fragment.
constexpr std::uint64_t FragmentBytes = std::uint64_t(1) << 18;

} // namespace

RecordSource::RecordSource(
  const RecordReader& reader, const SortedCells& cells, std::uint64_t first, std::uint64_t last)
  : Reader(reader)
  , Cells(cells)
  , RecordBytes(reader.GetKind().RecordBytes)
  , Cell(first)
  , LastCell(last)
{
  if (first < last)
  {
    this->Begin = cells.GetRange(first).first;
    this->End = cells.GetRange(last - 1).second;
    this->Position = this->Begin;
  }
}

bool RecordSource::Next(dsm::Fragment& fragment)
{
  while (this->Cell < this->LastCell && this->Position >= this->Cells.GetRange(this->Cell).second)
  {
    ++this->Cell;
  }
  if (this->Cell >= this->LastCell)
  {
    return false;
  }
  const std::size_t size = this->RecordBytes;
  const std::uint64_t count = std::min(this->Cells.GetRange(this->Cell).second - this->Position,
    std::max<std::uint64_t>(FragmentBytes / size, 1));
  fragment.Block = this->Cell;
  fragment.Bytes.resize(count * size);
  std::byte* bytes = fragment.Bytes.data();
  for (std::uint64_t index = 0; index < count; ++index)
  {
    this->Reader.ReadRecord(
      this->Cells.GetPrimitive(this->Position++), reinterpret_cast<std::uint32_t*>(bytes));
    bytes += size;
  }
  return true;
}

double RecordSource::GetProgress() const
{
  return this->End > this->Begin ? static_cast<double>(this->Position - this->Begin) /
      static_cast<double>(this->End - this->Begin)
                                 : 1.0;
}

class RecordBlocks::Sink final : public dsm::FragmentSink
{
public:
  void Begin(dsm::BlockId, std::byte*, std::size_t) override {}
  void Absorb(dsm::BlockId id, std::byte* block, std::size_t bytes, const std::byte* fragment,
    std::size_t fragmentBytes) override
  {
    std::uint64_t filled;
    std::memcpy(&filled, block, sizeof(filled));
    if (fragmentBytes > bytes - RecordOffset - filled)
    {
      throw dsm::Error("Cell " + std::to_string(id) +
        " received more records than expected. Do all ranks run the same build?");
    }
    std::memcpy(block + RecordOffset + filled, fragment, fragmentBytes);
    filled += fragmentBytes;
    std::memcpy(block, &filled, sizeof(filled));
  }
  void Finish(dsm::BlockId id, std::byte* block, std::size_t bytes) override
  {
    std::uint64_t filled;
    std::memcpy(&filled, block, sizeof(filled));
    if (RecordOffset + filled != bytes)
    {
      throw dsm::Error("Cell " + std::to_string(id) +
        " received fewer records than expected. Did the dataset change in the meantime?");
    }
  }
};

/// The memory of this rank's cells, one after the other.
class RecordBlocks::Segment final : public dsm::BlockSegment
{
public:
  Segment(std::uint32_t number, dsm::BlockDirectory&& directory, int rank, int ranks)
    : BlockSegment(number, std::move(directory))
    , Rank(rank)
    , Ranks(ranks)
    , Memory(this->GetDirectory().GetResidentBytes(rank))
  {
    std::size_t offset = 0;
    for (dsm::BlockId id = 0; id < this->GetDirectory().GetCount(); ++id)
    {
      if (this->GetDirectory().GetOwner(id) == rank)
      {
        this->Offsets.push_back(offset);
        offset += dsm::AlignBlock(this->GetDirectory().GetBytes(id));
      }
    }
  }
  std::byte* GetOwned(dsm::BlockId id) const override
  {
    return this->Memory.GetData() + this->Offsets[id / static_cast<dsm::BlockId>(this->Ranks)];
  }
  void ForEachResident(const Visit& visit) const override
  {
    for (std::size_t index = 0; index < this->Offsets.size(); ++index)
    {
      const auto id =
        static_cast<dsm::BlockId>(this->Rank) + index * static_cast<dsm::BlockId>(this->Ranks);
      visit(id, this->GetOwned(id), this->GetDirectory().GetBytes(id));
    }
  }
  std::uint64_t GetResidentBytes() const override
  {
    return this->GetDirectory().GetResidentBytes(this->Rank);
  }
  void Seal() override {}

private:
  int Rank;
  int Ranks;
  dsm::BlockArena Memory;
  std::vector<std::size_t> Offsets;
};

RecordBlocks::~RecordBlocks() = default;

RecordBlocks::RecordBlocks(std::string_view what, const SortedCells& cells,
  const RecordReader& reader, dsm::FragmentSource& source, dsm::Messenger& messenger,
  dsm::FunctionRef<void(double)> progress)
  : Rank(messenger.GetRank())
  , Ranks(messenger.GetSize())
{
  std::vector<std::uint32_t> bytes;
  messenger.RunTogether(what,
    [&]
    {
      const RecordKind kind = reader.GetKind();
      bytes.reserve(cells.GetCount());
      for (std::uint64_t cell = 0; cell < cells.GetCount(); ++cell)
      {
        const std::uint64_t needed =
          RecordOffset + cells.GetPrimitiveCount(cell) * kind.RecordBytes;
        if (needed > std::numeric_limits<std::uint32_t>::max() - dsm::BlockAlignment)
        {
          throw dsm::Error(std::to_string(cells.GetPrimitiveCount(cell)) + " " + kind.Primitives +
            " have the same centroid. Remove duplicate " + kind.Primitives + " or outlier points.");
        }
        bytes.push_back(static_cast<std::uint32_t>(needed));
      }
    });
  const auto count = [this](const dsm::BlockDirectory& directory)
  { return directory.GetResidentBytes(this->Rank); };
  const auto create = [this](std::uint32_t number, dsm::BlockDirectory&& directory)
  { return std::make_shared<Segment>(number, std::move(directory), this->Rank, this->Ranks); };
  Sink sink;
  this->Records =
    dsm::SegmentPublisher(messenger, what, { count, create })
      .Run({ std::move(bytes), dsm::RoundRobinAssigner(this->Ranks) }, source, sink, progress);
}

bool BlockSource::Next(dsm::Fragment& fragment)
{
  if (this->Position == this->Blocks.size())
  {
    return false;
  }
  fragment = std::move(this->Blocks[this->Position++]);
  return true;
}

double BlockSource::GetProgress() const
{
  return this->Blocks.empty()
    ? 1.0
    : static_cast<double>(this->Position) / static_cast<double>(this->Blocks.size());
}

void BlockSink::Begin(dsm::BlockId, std::byte*, std::size_t) {}

void BlockSink::Absorb(dsm::BlockId id, std::byte* block, std::size_t bytes,
  const std::byte* fragment, std::size_t fragmentBytes)
{
  if (fragmentBytes != bytes)
  {
    throw dsm::Error("Block " + std::to_string(id) + " has " + std::to_string(bytes) +
      " bytes, but " + std::to_string(fragmentBytes) +
      " arrived for it. Do all ranks run the same build?");
  }
  std::memcpy(block, fragment, fragmentBytes);
}

void BlockSink::Finish(dsm::BlockId, std::byte*, std::size_t) {}

} // namespace bricks
