// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_RecordExchange_h
#define bricks_RecordExchange_h

#include "DSMBricks/sorted/RecordReader.h"
#include "DSMBricks/sorted/SortedCells.h"
#include "DSMCore/base/Block.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace bricks
{

/// Yields the records of this rank's primitives in cells [first, last), in pieces of bounded size.
class RecordSource final : public dsm::FragmentSource
{
public:
  RecordSource(
    const RecordReader& reader, const SortedCells& cells, std::uint64_t first, std::uint64_t last);
  bool Next(dsm::Fragment& fragment) override;
  double GetProgress() const override;

private:
  const RecordReader& Reader;
  const SortedCells& Cells;
  std::size_t RecordBytes;
  std::uint64_t Cell;
  std::uint64_t LastCell;
  std::uint64_t Begin = 0; ///< this rank's primitives in the cells
  std::uint64_t End = 0;
  std::uint64_t Position = 0;
};

/// The records of the cells that this rank owns, in no order within a cell. In memory of their own,
/// not in the store: they are read once, by their owner, whatever organization the bricks will have.
class RecordBlocks
{
public:
  /// Collective: every rank's source goes to the owners, round robin by cell. Throws dsm::Error on
  /// every rank alike. `progress` may be empty.
  RecordBlocks(std::string_view what, const SortedCells& cells, const RecordReader& reader,
    dsm::FragmentSource& source, dsm::Messenger& messenger,
    dsm::FunctionRef<void(double)> progress);

  ~RecordBlocks();

  /// Own cells, in order.
  std::size_t GetCount() const
  {
    const std::uint64_t cells = this->Records->GetDirectory().GetCount();
    const auto rank = static_cast<std::uint64_t>(this->Rank);
    const auto ranks = static_cast<std::uint64_t>(this->Ranks);
    return static_cast<std::size_t>((cells + ranks - 1 - rank) / ranks);
  }
  std::uint64_t GetCell(std::size_t index) const
  {
    return static_cast<std::uint64_t>(this->Rank) + index * static_cast<std::uint64_t>(this->Ranks);
  }
  const std::uint32_t* GetRecords(std::size_t index) const
  {
    return reinterpret_cast<const std::uint32_t*>(
      this->Records->GetOwned(this->GetCell(index)) + RecordOffset);
  }

private:
  class Segment;
  class Sink;
  /// A block begins with the number of bytes of records that it has (64 bits).
  static constexpr std::size_t RecordOffset = dsm::BlockAlignment;

  int Rank;
  int Ranks;
  std::shared_ptr<dsm::BlockSegment> Records;
};

/// Yields whole blocks that this rank has made.
class BlockSource final : public dsm::FragmentSource
{
public:
  explicit BlockSource(std::vector<dsm::Fragment> blocks)
    : Blocks(std::move(blocks))
  {
  }
  bool Next(dsm::Fragment& fragment) override;
  double GetProgress() const override;

private:
  std::vector<dsm::Fragment> Blocks;
  std::size_t Position = 0;
};

/// Takes whole blocks.
class BlockSink final : public dsm::FragmentSink
{
public:
  void Begin(dsm::BlockId id, std::byte* block, std::size_t bytes) override;
  void Absorb(dsm::BlockId id, std::byte* block, std::size_t bytes, const std::byte* fragment,
    std::size_t fragmentBytes) override;
  void Finish(dsm::BlockId id, std::byte* block, std::size_t bytes) override;
};

} // namespace bricks

#endif
