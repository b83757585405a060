// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_RecordExchange_h
#define bricks_RecordExchange_h

#include "DSMBricks/sorted/RecordReader.h"
#include "DSMBricks/sorted/SortedCells.h"
#include "DSMCore/base/Block.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/memory/BlockArena.h"
#include "DSMCore/publish/BlockDirectory.h"
#include "DSMCore/publish/Publication.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace bricks
{

/// Yields the records of this rank's primitives in cells [first, last) of other ranks, in pieces of bounded size. Cells
/// belong to the ranks in turn.
class RecordSource final : public dsm::FragmentSource
{
public:
  RecordSource(const RecordReader& reader, const SortedCells& cells, std::uint64_t first,
    std::uint64_t last, const dsm::RoundRobinAssigner& owners, int rank);
  bool Next(dsm::Fragment& fragment) override;
  double GetProgress() const override;

private:
  bool IsDone() const { return this->Position >= this->Cells.GetRange(this->Cell).second; }
  /// Moves to the first of the cells from this one on that another rank owns.
  void FindOthers();

  const RecordReader& Reader;
  const SortedCells& Cells;
  std::size_t RecordBytes;
  std::uint64_t FirstCell;
  std::uint64_t Cell;
  std::uint64_t LastCell;
  dsm::RoundRobinAssigner Owners;
  int Rank;
  std::uint64_t Position = 0;
};

/// The records that other ranks have for the cells of this rank, in no order within a cell. They are read once, by
/// their owner, whatever organization the bricks will have, so they are not in the store. A rank's own primitives are
/// read where they are.
class ArrivedRecords
{
public:
  /// Collective: every rank's source goes to the owners. Throws dsm::Error on every rank alike. `progress` may be
  /// empty.
  ArrivedRecords(std::string_view what, const SortedCells& cells, std::size_t recordBytes,
    dsm::FragmentSource& source, dsm::Messenger& messenger,
    dsm::FunctionRef<void(double)> progress);

  /// Own cells, in order.
  std::size_t GetCellCount() const { return this->Ends.size(); }
  std::uint64_t GetCell(std::size_t index) const
  {
    return static_cast<std::uint64_t>(this->Rank) + index * static_cast<std::uint64_t>(this->Ranks);
  }
  std::size_t GetBytes(std::size_t index) const
  {
    return this->Ends[index] - this->GetBegin(index);
  }
  const std::byte* GetRecords(std::size_t index) const
  {
    return this->Memory.GetData() + this->GetBegin(index);
  }

private:
  std::size_t GetBegin(std::size_t index) const { return index == 0 ? 0 : this->Ends[index - 1]; }

  int Rank;
  int Ranks;
  std::vector<std::size_t> Ends; ///< of own cells, in bytes
  dsm::BlockArena Memory;
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
