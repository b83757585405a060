// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_TriangleCells_h
#define bricks_TriangleCells_h

#include "DSMBricks/base/MortonCode.h"
#include "DSMBricks/build/TriangleReader.h"
#include "DSMCore/transport/Messenger.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace bricks
{

/// The mesh's triangles in spatial order (the paper, section 4.3), cut into cells of at most a
/// brickful. A cell is a part of the octree over the mesh, halved along one axis at a time, so all
/// its triangles begin with the same bits of the Morton code of their centroid. The cells are found
/// by counting on all ranks together, so they are a function of the mesh, not of who has what. Where
/// the paper's preprocessing rewrites a file, here only 16 bytes a triangle are sorted, and each
/// rank its own.
class TriangleCells
{
public:
  /// Collective. Throws dsm::Error on every rank alike.
  TriangleCells(const TriangleReader& reader, std::uint64_t triangles, const MortonCode& order,
    std::uint64_t largestCount, int threads, dsm::Messenger& messenger);

  /// Cells are numbered along the curve; none is empty.
  std::uint64_t GetCount() const { return this->Cells.size(); }
  /// Over all ranks.
  std::uint64_t GetTriangleCount(std::uint64_t cell) const { return this->Cells[cell].Count; }
  /// This rank's part of the cell: numbers of triangles of the source, `second` past the last.
  std::pair<std::uint64_t, std::uint64_t> GetRange(std::uint64_t cell) const
  {
    return { this->Cells[cell].Begin, this->Cells[cell].End };
  }
  std::uint64_t GetTriangle(std::uint64_t index) const { return this->Keys[index].Triangle; }

  /// Of this rank's triangles: those that no ray can hit; they are in no cell.
  std::uint64_t GetDropped() const { return this->Dropped; }

private:
  struct Key
  {
    std::uint64_t Code;
    std::uint64_t Triangle;
  };
  struct Cell
  {
    std::uint64_t Code; ///< of its first place
    int Bits;           ///< how many of the code's bits all its places share
    std::uint64_t Begin;
    std::uint64_t End;
    std::uint64_t Count; ///< over all ranks
  };

  void ReadKeys(
    const TriangleReader& reader, std::uint64_t triangles, const MortonCode& order, int threads);
  void SortKeys(int threads);
  void FindCells(std::uint64_t largestCount, dsm::Messenger& messenger);
  /// Where the parts of a cell that share `bits` more bits begin, and the last one ends.
  std::vector<std::uint64_t> Divide(const Cell& cell, int bits) const;

  std::vector<Key> Keys;
  std::vector<Cell> Cells;
  std::uint64_t Dropped = 0;
};

} // namespace bricks

#endif
