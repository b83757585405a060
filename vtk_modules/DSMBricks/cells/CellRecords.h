// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CellRecords_h
#define bricks_CellRecords_h

#include "DSMBricks/base/MortonCode.h"
#include "DSMBricks/cells/CellBrickWriter.h"
#include "DSMBricks/cells/CellSource.h"
#include "DSMBricks/cells/PointPlaces.h"
#include "DSMBricks/layout/BrickSpace.h"
#include "DSMBricks/sorted/RecordReader.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace bricks
{

/// A corner of a cell, as it travels between ranks; a record has all corners of a cell, in their order.
struct CornerRecord
{
  float Place[3]; ///< in the space of bricks
  std::uint32_t Rank;
  std::uint32_t Point; ///< number of the point in that rank's source
};

/// Makes records out of the cells of a source that are in no structured grid. May be used by several threads at a time.
class CellRecordReader final : public RecordReader
{
public:
  /// `corners`: of each cell, on all ranks: 4 or 8. Cells with fewer repeat their last ones.
  CellRecordReader(const CellSource& source, int corners, int rank);

  RecordKind GetKind() const override;
  std::uint64_t GetCount() const override { return this->Count; }
  /// Counts the points of shown cells, and all points of structured grids. Takes a byte a point while it runs. Throws
  /// dsm::Error when a cell has a point that the source does not.
  PositionBounds FindBounds(int threads) const override;
  void SetSpace(const BrickSpace& space, int threads) override;
  /// The codes are those of the means of the corners.
  void FindCodes(std::uint64_t begin, std::uint64_t end, const MortonCode& order,
    std::uint64_t* codes) const override;
  void ReadRecords(
    const std::uint64_t* primitives, std::size_t count, std::uint32_t* records) const override;
  std::unique_ptr<RecordBrickBuilder> CreateBuilder(
    const MortonCode& order, std::uint32_t largestCount) const override;

private:
  static constexpr std::size_t CellsTogether = 64;

  /// Cells that follow one another, and are in no grid.
  struct Run
  {
    std::uint64_t FirstPrimitive;
    std::uint64_t FirstCell;
  };

  /// Calls visit(primitive, points, isShown) for primitives [begin, end), in order.
  template <class Visit>
  void ForEachPrimitive(std::uint64_t begin, std::uint64_t end, const Visit& visit) const;
  /// The run that a primitive is in.
  const Run& FindRun(std::uint64_t primitive) const;
  /// Reads records of at most CellsTogether cells.
  void ReadBatch(const std::uint64_t* primitives, std::size_t count, CornerRecord* corners) const;
  /// Points of a corner each, of those that the source gives for a cell.
  void Expand(const std::uint64_t* given, std::uint64_t points[CellSource::MostCorners]) const;

  const CellSource& Source;
  int Corners;
  int GivenCorners; ///< that the source has of each cell
  std::uint32_t Rank;
  std::vector<Run> Runs;
  std::uint64_t Count = 0;
  PointPlaces Places;
};

/// Makes bricks of such records; see RecordBrickBuilder. A brick's notes are rank and number of each of its points.
class CellRecordBuilder final : public RecordBrickBuilder
{
public:
  CellRecordBuilder(int corners, const MortonCode& order, std::uint32_t largestCount);

  std::vector<RecordBrick> Build(const std::uint32_t* records, std::size_t count) override;

private:
  struct Key
  {
    std::uint64_t Code;
    const CornerRecord* Record;
  };
  /// A point that was found.
  struct Entry
  {
    std::uint32_t Point;
    std::uint32_t Number; ///< in Found plus one; 0: the entry is free
  };

  /// Sorts the cells by code, and cells of the same code by their corners.
  void SortCells(const std::uint32_t* records, std::size_t count);
  RecordBrick BuildBrick(const Key* keys, std::size_t count);
  /// Numbers the points of some cells.
  void CollectPoints(const Key* keys, std::size_t count);
  std::uint32_t FindPoint(const CornerRecord& corner);
  void EnlargeTable(std::size_t size);
  /// The entry of a point, or the free one where it belongs.
  Entry& FindEntry(const CornerRecord& corner);

  int Corners;
  MortonCode Curve;
  std::uint32_t LargestCount;
  std::vector<Key> Keys;
  std::vector<CornerRecord> Found; ///< each point once
  std::vector<Entry> Table;        ///< by hash
  bool AreOfOneRank = false;       ///< all records
  std::vector<std::uint16_t> CornerNumbers;
  std::vector<float> Points;
  CellBrickWriter Writer;
};

} // namespace bricks

#endif
