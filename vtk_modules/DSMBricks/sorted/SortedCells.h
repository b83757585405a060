// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_SortedCells_h
#define bricks_SortedCells_h

#include "DSMBricks/base/MortonCode.h"
#include "DSMBricks/sorted/RecordReader.h"
#include "DSMCore/base/FunctionRef.h"
#include "DSMCore/memory/BlockArena.h"
#include "DSMCore/transport/Messenger.h"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace bricks
{

/// Primitives in spatial order (the paper, section 4.3), cut into cells of at most a brickful. A cell is a part of
/// the octree over all, halved along one axis at a time, so the codes of its primitives begin with the same bits.
/// The cells are found by counting on all ranks together, so they are a function of the primitives, not of who has
/// what. Where the paper's preprocessing rewrites a file, here only 16 bytes a primitive are sorted, and each rank
/// its own.
class SortedCells
{
public:
  /// Collective. Throws dsm::Error on every rank alike; `what` names the primitives in it. `progress` may be empty.
  SortedCells(std::string_view what, const RecordReader& reader, const MortonCode& order,
    std::uint64_t largestCount, int threads, dsm::Messenger& messenger,
    dsm::FunctionRef<void(double)> progress);

  /// Cells are numbered along the curve; none is empty.
  std::uint64_t GetCount() const { return this->Cells.size(); }
  /// Over all ranks.
  std::uint64_t GetPrimitiveCount(std::uint64_t cell) const { return this->Cells[cell].Count; }
  /// This rank's part of the cell in the order of all its primitives; `second` is past the last.
  std::pair<std::uint64_t, std::uint64_t> GetRange(std::uint64_t cell) const
  {
    return { this->Cells[cell].Begin, this->Cells[cell].End };
  }
  /// Writes the records of primitives [begin, end) of the range of a cell. Any thread.
  void ReadRecords(const RecordReader& reader, std::uint64_t begin, std::uint64_t end,
    std::uint32_t* records) const;

private:
  struct Key
  {
    std::uint64_t Code;
    std::uint64_t Primitive;
  };
  struct Cell
  {
    std::uint64_t Code; ///< code of the first position in the cell
    int Bits;           ///< how many of the code's bits all its places share
    std::uint64_t Begin;
    std::uint64_t End;
    std::uint64_t Count; ///< over all ranks
  };

  void ReadKeys(const RecordReader& reader, const MortonCode& order, int threads,
    dsm::FunctionRef<void(double)> progress);
  void SortKeys(int threads, dsm::FunctionRef<void(double)> progress);
  void FindCells(std::string_view what, std::uint64_t largestCount, dsm::Messenger& messenger);
  /// Returns the begins of the parts of a cell that share `bits` more bits, and the end of the last
  /// part.
  std::vector<std::uint64_t> Divide(const Cell& cell, int bits) const;

  dsm::BlockArena Memory;
  Key* Keys = nullptr; ///< in Memory
  std::size_t KeyCount = 0;
  std::vector<Cell> Cells;
};

} // namespace bricks

#endif
