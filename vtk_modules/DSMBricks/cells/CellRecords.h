// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CellRecords_h
#define bricks_CellRecords_h

#include "DSMBricks/base/MortonCode.h"
#include "DSMBricks/cells/CellBrickWriter.h"
#include "DSMBricks/cells/CellSource.h"
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
  /// The bounds of the structured grids.
  void FindOtherBounds(glm::dvec3& lower, glm::dvec3& upper) const override;
  /// Throws dsm::Error when the cell has a point that the source does not.
  bool FindBounds(std::uint64_t primitive, glm::dvec3& lower, glm::dvec3& upper) const override;
  void SetSpace(const BrickSpace& space) override { this->Space = space; }
  /// The code is that of the mean of the corners.
  bool FindCode(
    std::uint64_t primitive, const MortonCode& order, std::uint64_t& code) const override;
  void ReadRecord(std::uint64_t primitive, std::uint32_t* record) const override;
  std::unique_ptr<RecordBrickBuilder> CreateBuilder(
    const MortonCode& order, std::uint32_t largestCount) const override;

private:
  /// Cells that follow one another, and are in no grid.
  struct Run
  {
    std::uint64_t FirstPrimitive;
    std::uint64_t FirstCell;
  };

  std::uint64_t GetCell(std::uint64_t primitive) const;
  /// Returns whether all corners are finite.
  bool ReadCorners(std::uint64_t primitive, CornerRecord corners[CellBrick::MostCorners]) const;

  const CellSource& Source;
  int Corners;
  std::uint32_t Rank;
  std::vector<Run> Runs;
  std::uint64_t Count = 0;
  BrickSpace Space;
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

  void Sort(const std::uint32_t* records, std::size_t count);
  RecordBrick BuildBrick(const Key* keys, std::size_t count);
  /// Numbers the points of some cells in ascending order.
  void CollectPoints(const Key* keys, std::size_t count);
  std::uint32_t FindPoint(const CornerRecord& corner);

  int Corners;
  MortonCode Order;
  std::uint32_t LargestCount;
  std::vector<Key> Keys;
  std::vector<CornerRecord> Found;  ///< each point once
  std::vector<std::uint32_t> Table; ///< numbers in Found plus one, by hash; 0 is free
  std::vector<std::uint32_t> CornersFound;
  std::vector<std::uint16_t> Numbers; ///< of the points in Found, in ascending order
  std::vector<std::uint16_t> CornerNumbers;
  std::vector<float> Points;
  CellBrickWriter Writer;
};

} // namespace bricks

#endif
