// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CellBrick_h
#define bricks_CellBrick_h

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/cells/PackedGradient.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace bricks
{

/// Header of a brick of cells: their points and corners, and a hierarchy over groups of up to eight cells, but no
/// values. Layout of the block, in this order:
///
///   this header   64 bytes
///   nodes         80 bytes each (WideBvhNode); the first one is the root; a leaf is one group
///   points        three floats each, in the space of the bricks: the same point has the same bits in all bricks, so no
///                 ray slips between them
///   corners       16-bit numbers of points, header.Corners a cell, the cells of a group one after the other; none for
///                 a brick of a structured grid
///   shown         a byte for each cell of a structured grid, x fastest, 1 where it is shown; none where all are
///
/// Every part starts at a multiple of 16 bytes. Offsets are from the start of the block. In a brick that is not of
/// a grid, points are in ascending order of x, then y, then z, and so in the same order in all bricks that have them.
struct CellBrickHeader
{
  std::uint32_t BlockBytes;
  std::uint16_t Points;
  std::uint16_t Cells; ///< that are shown
  std::uint16_t Nodes;
  std::uint16_t Groups;
  std::uint16_t Corners; ///< of each cell: 4 or 8
  std::uint16_t
    GridCells[3]; ///< on each axis, x fastest; 0 for a brick that is not of a structured grid
  std::uint32_t PointOffset;
  std::uint32_t CornerOffset; ///< 0 for a brick of a grid
  std::uint32_t ShownOffset;  ///< 0: all are shown
  std::uint8_t Unused[32];

  static constexpr std::uint32_t NodeOffset = 64;
  /// Cells of a group, at most.
  static constexpr int GroupSize = 8;
  /// Groups are numbered with 13 bits in the leaves of the tree.
  static constexpr std::uint32_t MostGroups = 8191;
  static constexpr std::uint32_t MostCells = GroupSize * MostGroups;
  static constexpr std::uint32_t MostPoints = 65535;
};

static_assert(sizeof(CellBrickHeader) == CellBrickHeader::NodeOffset, "nodes follow");

/// The bytes of a brick of cells. A view: valid as long as the block is.
class CellBrick
{
public:
  using Node = WideBvhNode<std::uint16_t>;
  static constexpr int GroupSize = CellBrickHeader::GroupSize;
  static constexpr int MostCorners = 8;

  explicit CellBrick(const std::byte* block)
    : Block(block)
  {
  }

  const CellBrickHeader& GetHeader() const
  {
    return *reinterpret_cast<const CellBrickHeader*>(this->Block);
  }
  const Node* GetNodes() const
  {
    return reinterpret_cast<const Node*>(this->Block + CellBrickHeader::NodeOffset);
  }
  /// Three coordinates; a fourth float can be read, too.
  const float* GetPoint(std::uint32_t point) const
  {
    return reinterpret_cast<const float*>(this->Block + this->GetHeader().PointOffset) + 3 * point;
  }
  bool IsOfGrid() const { return this->GetHeader().GridCells[0] != 0; }

  /// The group that a leaf refers to.
  static std::uint32_t GetGroup(std::uint16_t leaf) { return leaf & MostNumber; }

  /// Writes the corners of the shown cells of a group: as many as header.Corners each, in VTK's order. Returns how
  /// many cells there are.
  int ReadGroup(std::uint32_t group, std::uint16_t corners[GroupSize][MostCorners]) const
  {
    const CellBrickHeader& header = this->GetHeader();
    if (this->IsOfGrid())
    {
      return this->ReadGroupOfGrid(group, corners);
    }
    const std::uint32_t first = group * GroupSize;
    const std::uint32_t left = header.Cells - first;
    const int count = left < GroupSize ? static_cast<int>(left) : GroupSize;
    const auto* from = reinterpret_cast<const std::uint16_t*>(this->Block + header.CornerOffset) +
      std::size_t(first) * header.Corners;
    for (int cell = 0; cell < count; ++cell, from += header.Corners)
    {
      // Copies of a constant size need no call.
      if (header.Corners == MostCorners)
      {
        std::memcpy(corners[cell], from, MostCorners * sizeof(std::uint16_t));
      }
      else
      {
        std::memcpy(corners[cell], from, 4 * sizeof(std::uint16_t));
      }
    }
    return count;
  }

  /// Groups of a grid are boxes of 2 x 2 x 2 cells, x fastest.
  static void GetGroupsOfGrid(const std::uint16_t cells[3], std::uint32_t groups[3])
  {
    groups[0] = (cells[0] + 1u) / 2u;
    groups[1] = (cells[1] + 1u) / 2u;
    groups[2] = (cells[2] + 1u) / 2u;
  }

private:
  static constexpr std::uint16_t MostNumber = 0x1fffu;

  int ReadGroupOfGrid(std::uint32_t group, std::uint16_t corners[GroupSize][MostCorners]) const
  {
    const CellBrickHeader& header = this->GetHeader();
    std::uint32_t groups[3];
    GetGroupsOfGrid(header.GridCells, groups);
    const std::uint32_t first[3] = { group % groups[0] * 2u, group / groups[0] % groups[1] * 2u,
      group / (groups[0] * groups[1]) * 2u };
    const std::uint32_t row = header.GridCells[0] + 1u;
    const std::uint32_t slice = row * (header.GridCells[1] + 1u);
    const auto* const shown =
      reinterpret_cast<const std::uint8_t*>(this->Block + header.ShownOffset);
    int count = 0;
    for (std::uint32_t part = 0; part < GroupSize; ++part)
    {
      const std::uint32_t x = first[0] + (part & 1u);
      const std::uint32_t y = first[1] + (part >> 1 & 1u);
      const std::uint32_t z = first[2] + (part >> 2);
      const std::uint32_t cell = x + header.GridCells[0] * (y + header.GridCells[1] * z);
      if (x < header.GridCells[0] && y < header.GridCells[1] && z < header.GridCells[2] &&
        (header.ShownOffset == 0 || shown[cell] != 0))
      {
        const std::uint32_t point = x + row * y + slice * z;
        const std::uint32_t numbers[MostCorners] = { point, point + 1, point + row + 1, point + row,
          point + slice, point + slice + 1, point + slice + row + 1, point + slice + row };
        for (int corner = 0; corner < MostCorners; ++corner)
        {
          corners[count][corner] = static_cast<std::uint16_t>(numbers[corner]);
        }
        ++count;
      }
    }
    return count;
  }

  const std::byte* Block;
};

/// Header of the values of a brick of cells, a block of its own. Layout, in this order:
///
///   this header   32 bytes
///   values        one float a point of the brick; NaN: no value
///   gradients     one PackedGradient a point, in the space of the bricks, if there are any
///   ranges        for each node of the brick the lower bounds of its eight children's values, a byte each, then their
///                 upper bounds: First + Step * byte, rounded outward; a child without values has a lower bound
///                 above its upper one
///
/// Every part starts at a multiple of 16 bytes.
struct CellValueHeader
{
  std::uint32_t BlockBytes;
  std::uint32_t GradientOffset; ///< 0: none
  std::uint32_t RangeOffset;
  float First;
  float Step;
  float Last; ///< of all values, exactly, as First; First > Last if there are none
  std::uint8_t Unused[8];

  static constexpr std::uint32_t ValueOffset = 32;
  static constexpr float Steps = 255.0f;
};

static_assert(sizeof(CellValueHeader) == CellValueHeader::ValueOffset, "values follow");

/// The bytes of such a block. A view.
class CellValueBrick
{
public:
  explicit CellValueBrick(const std::byte* block)
    : Block(block)
  {
  }
  const CellValueHeader& GetHeader() const
  {
    return *reinterpret_cast<const CellValueHeader*>(this->Block);
  }
  const float* GetValues() const
  {
    return reinterpret_cast<const float*>(this->Block + CellValueHeader::ValueOffset);
  }
  /// Null: there are none.
  const PackedGradient* GetGradients() const
  {
    const std::uint32_t offset = this->GetHeader().GradientOffset;
    return offset == 0 ? nullptr : reinterpret_cast<const PackedGradient*>(this->Block + offset);
  }
  /// Eight lower bounds, then eight upper bounds.
  const std::uint8_t* GetRanges(std::uint32_t node) const
  {
    return reinterpret_cast<const std::uint8_t*>(this->Block + this->GetHeader().RangeOffset) +
      2 * WideBvhWidth * node;
  }

private:
  const std::byte* Block;
};

} // namespace bricks

#endif
