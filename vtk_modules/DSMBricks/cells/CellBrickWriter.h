// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CellBrickWriter_h
#define bricks_CellBrickWriter_h

#include "DSMBricks/accel/BoundingBox.h"
#include "DSMBricks/accel/WideBvhBuilder.h"
#include "DSMBricks/cells/CellBrick.h"
#include "DSMBricks/sorted/RecordReader.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bricks
{

/// Writes bricks of cells. One for each thread; keeps its storage from one brick to the next.
class CellBrickWriter
{
public:
  CellBrickWriter()
    : Tree(1, WideBvhShape::Full)
  {
  }

  /// A brick of cells of `cornersOfCell` corners each, 4 or 8. `points`: three floats each; `corners`: numbers of
  /// points.
  RecordBrick Write(
    const std::vector<float>& points, const std::vector<std::uint16_t>& corners, int cornersOfCell);
  /// The points of the last brick so written in the order in which it has them: their numbers in `points`.
  const std::vector<std::uint16_t>& GetPointOrder() const { return this->PointOrder; }

  /// A brick of so many cells of a structured grid on each axis. `points`: three floats each, x fastest; `shown`: one
  /// byte a cell, or empty if all are shown. Without bytes if no cell is shown.
  RecordBrick WriteGrid(const std::vector<float>& points, const std::uint16_t cells[3],
    const std::vector<std::uint8_t>& shown);

private:
  /// Orders cells so that those of each group are near one another.
  void OrderCells(
    int cornersOfCell, const std::vector<float>& points, const std::vector<std::uint16_t>& corners);
  void Divide(std::size_t begin, std::size_t end);
  /// Writes Heads and Bytes for the cells in their order, and PointOrder. The header has Points and Corners already.
  void WriteGroups(const CellBrickHeader& header, const std::vector<float>& points,
    const std::vector<std::uint16_t>& corners);
  /// Writes the next group, of `count` cells from `first` on.
  void WriteGroup(const CellBrickHeader& header, std::size_t first, std::size_t count,
    const std::vector<float>& points, const std::vector<std::uint16_t>& corners);
  /// Writes a brick of which all but the nodes is known: Heads and Bytes, or the splits of a grid's cells. Without
  /// bytes if it has no cells.
  RecordBrick Assemble(
    CellBrickHeader header, const std::vector<float>& points, const std::vector<SplitCode>& splits);
  /// Boxes of the groups that have cells, and which groups they are, of a block without nodes. Returns its cells.
  std::uint32_t MeasureGroups(const std::byte* block);

  std::vector<float> Centers;       ///< of the cells, times their corners; three each
  std::vector<std::uint32_t> Order; ///< of the cells
  std::vector<std::uint16_t> PointOrder;
  std::vector<std::uint16_t> NewNumbers; ///< of the points; NoNumber: in no group yet
  std::vector<float> OrderedPoints;
  std::vector<CellGroupHead> Heads;
  std::vector<std::byte> Bytes;
  std::vector<BoundingBox> Boxes;
  std::vector<std::uint32_t> Groups;
  WideBvhBuilder<std::uint16_t> Tree;
};

} // namespace bricks

#endif
