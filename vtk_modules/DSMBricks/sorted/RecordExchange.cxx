// SPDX-License-Identifier: BSD-3-Clause
#include "DSMBricks/sorted/RecordExchange.h"

#include "DSMCore/base/Error.h"
#include "DSMCore/publish/FragmentStream.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

namespace bricks
{

namespace
{

/// Bytes of records in one fragment.
constexpr std::uint64_t FragmentBytes = std::uint64_t(1) << 18;

} // namespace

RecordSource::RecordSource(const RecordReader& reader, const SortedCells& cells,
  std::uint64_t first, std::uint64_t last, const dsm::RoundRobinAssigner& owners, int rank)
  : Reader(reader)
  , Cells(cells)
  , RecordBytes(reader.GetKind().RecordBytes)
  , FirstCell(first)
  , Cell(first)
  , LastCell(last)
  , Owners(owners)
  , Rank(rank)
{
  this->FindOthers();
}

void RecordSource::FindOthers()
{
  while (this->Cell < this->LastCell && this->Owners.GetOwner(this->Cell) == this->Rank)
  {
    ++this->Cell;
  }
  if (this->Cell < this->LastCell)
  {
    this->Position = this->Cells.GetRange(this->Cell).first;
  }
}

bool RecordSource::Next(dsm::Fragment& fragment)
{
  while (this->Cell < this->LastCell && this->IsDone())
  {
    ++this->Cell;
    this->FindOthers();
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
  this->Cells.ReadRecords(this->Reader, this->Position, this->Position + count,
    reinterpret_cast<std::uint32_t*>(fragment.Bytes.data()));
  this->Position += count;
  return true;
}

double RecordSource::GetProgress() const
{
  return this->LastCell > this->FirstCell ? static_cast<double>(this->Cell - this->FirstCell) /
      static_cast<double>(this->LastCell - this->FirstCell)
                                          : 1.0;
}

ArrivedRecords::ArrivedRecords(std::string_view what, const SortedCells& cells,
  std::size_t recordBytes, dsm::FragmentSource& source, dsm::Messenger& messenger,
  dsm::FunctionRef<void(double)> progress)
  : Rank(messenger.GetRank())
  , Ranks(messenger.GetSize())
{
  std::vector<std::size_t> filled; // up to where, in Memory
  std::optional<dsm::BlockDirectory> directory;
  messenger.RunTogether(what,
    [&]
    {
      const auto first = static_cast<std::uint64_t>(this->Rank);
      const auto step = static_cast<std::uint64_t>(this->Ranks);
      std::size_t end = 0;
      for (std::uint64_t cell = first; cell < cells.GetCount(); cell += step)
      {
        const auto [begin, last] = cells.GetRange(cell);
        filled.push_back(end);
        end += (cells.GetPrimitiveCount(cell) - (last - begin)) * recordBytes;
        this->Ends.push_back(end);
      }
      this->Memory = dsm::BlockArena(end);
      directory.emplace(std::vector<std::uint32_t>(cells.GetCount(), 0),
        dsm::RoundRobinAssigner(messenger.GetSize()));
    });
  const auto absorb = [&](dsm::BlockId cell, const std::byte* bytes, std::size_t count)
  {
    const std::size_t index = cell / static_cast<std::size_t>(this->Ranks);
    if (count > this->Ends[index] - filled[index])
    {
      throw dsm::Error("Cell " + std::to_string(cell) +
        " received more records than expected. Do all ranks run the same build?");
    }
    std::memcpy(this->Memory.GetData() + filled[index], bytes, count);
    filled[index] += count;
  };
  const dsm::FirstFailure failure =
    dsm::FragmentStream::Run(messenger, *directory, source, absorb, progress);
  messenger.RunTogether(what,
    [&]
    {
      failure.Throw();
      for (std::size_t index = 0; index < filled.size(); ++index)
      {
        if (filled[index] != this->Ends[index])
        {
          throw dsm::Error("Cell " + std::to_string(this->GetCell(index)) +
            " received fewer records than expected. Did the dataset change in the meantime?");
        }
      }
    });
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
