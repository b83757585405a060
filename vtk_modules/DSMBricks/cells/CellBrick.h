// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_CellBrick_h
#define bricks_CellBrick_h

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/cells/PackedBits.h"
#include "DSMBricks/cells/PackedGradient.h"
#include "DSMBricks/cells/PackedPlaces.h"
#include "DSMBricks/cells/SplitCell.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace bricks
{

/// Up to eight cells of a brick, and their points, each once.
struct CellGroup
{
  static constexpr int MostCells = 8;
  static constexpr int MostCorners = 8;
  static constexpr int MostPoints = MostCells * MostCorners;

  int Cells;
  int Corners; ///< of each cell: 4 or 8
  int Points;
  std::uint16_t Numbers[MostPoints];       ///< of the points in the brick
  std::uint8_t At[MostCells][MostCorners]; ///< the corners: places in Numbers, in VTK's order
  SplitCode Splits[MostCells];             ///< of hexahedra
  static constexpr std::uint8_t OneTetrahedron[1][4] = { { 0, 1, 2, 3 } };

  ///@{
  /// The tetrahedra that a cell is split into: numbers of its corners.
  int CountParts() const { return this->Corners == 4 ? 1 : MostTetrahedra; }
  const std::uint8_t (*GetParts(int cell) const)[4]
  {
    return this->Corners == 4 ? OneTetrahedron : bricks::Splits[this->Splits[cell]].Corners;
  }
  ///@}
};

/// Header of a brick of cells: their points and corners, and a hierarchy over groups of up to eight cells, but no
/// values. Layout of the block, in this order:
///
///   this header   64 bytes
///   nodes         80 bytes each (WideBvhNode); the first one is the root; a leaf is one group
///   points        PackedPlaces, in the space of the bricks: the same point has the same bits in all bricks, so no ray
///                 slips between them
///   groups        a CellGroupHead each, then their bytes; none for a brick of a structured grid
///   splits        of the cells of a structured grid, a SplitCode each, x fastest; Hidden: the cell is not shown
///
/// Every part starts at a multiple of 16 bytes. Offsets are from the start of the block. In a brick that is not of
/// a grid, points are in the order in which groups have them first.
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
  std::uint32_t GroupOffset; ///< 0 for a brick of a grid
  std::uint32_t SplitOffset; ///< 0 for a brick that is not
  PackedPlacesHeader Places;
  std::uint8_t Unused[16];

  static constexpr std::uint32_t NodeOffset = 64;
  /// Cells of a group, at most.
  static constexpr int GroupSize = CellGroup::MostCells;
  /// Groups are numbered with 13 bits in the leaves of the tree.
  static constexpr std::uint32_t MostGroups = 8191;
  static constexpr std::uint32_t MostCells = GroupSize * MostGroups;
  static constexpr std::uint32_t MostPoints = 65535;
  static constexpr SplitCode Hidden = 255;

  int GetBitsOfPoint() const { return CountBits(this->Points - 1u); }
};

static_assert(sizeof(CellBrickHeader) == CellBrickHeader::NodeOffset, "nodes follow");

/// Where a group of a brick that is not of a grid is. Its bytes: a SplitCode for each hexahedron; then, in bits, the
/// corners of its cells, as places among its points, the new ones first; then the numbers of the points that groups
/// before it have, too. A corner has as few bits as the group's last point needs, a number as few as the brick's last
/// point needs.
struct CellGroupHead
{
  std::uint32_t Offset; ///< of its bytes, from the end of all heads
  std::uint16_t
    FirstNew; ///< number of the first point that no group before it has; the others follow
  std::uint8_t New;
  std::uint8_t Old;

  int GetBitsOfCorner() const { return CountBits(this->New + this->Old - 1u); }
};

static_assert(sizeof(CellGroupHead) == 8, "no padding");

/// The bytes of a brick of cells. A view: valid as long as the block is.
class CellBrick
{
public:
  using Node = WideBvhNode<std::uint16_t>;

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
  void GetPoint(std::uint32_t point, float place[3]) const { this->GetPlaces().Get(point, place); }
  /// Reads the places of a group's points. Each has room for four floats, of which the last stays as it is.
  void ReadPlaces(const CellGroup& group, float places[CellGroup::MostPoints][4]) const
  {
    const PackedPlaces packed = this->GetPlaces();
    for (int point = 0; point < group.Points; ++point)
    {
      packed.Get(group.Numbers[point], places[point]);
    }
  }
  bool IsOfGrid() const { return this->GetHeader().GridCells[0] != 0; }

  /// The group that a leaf refers to.
  static std::uint32_t GetGroup(std::uint16_t leaf) { return leaf & MostNumber; }

  /// Reads the shown cells of a group.
  void ReadGroup(std::uint32_t number, CellGroup& group) const
  {
    group.Corners = this->GetHeader().Corners;
    if (this->IsOfGrid())
    {
      this->ReadGroupOfGrid(number, group);
    }
    else
    {
      this->ReadOtherGroup(number, group);
    }
  }

  /// Groups of a grid are boxes of 2 x 2 x 2 cells, x fastest.
  static void GetGroupsOfGrid(const std::uint16_t cells[3], std::uint32_t groups[3])
  {
    groups[0] = (cells[0] + 1u) / 2u;
    groups[1] = (cells[1] + 1u) / 2u;
    groups[2] = (cells[2] + 1u) / 2u;
  }

  PackedPlaces GetPlaces() const
  {
    const CellBrickHeader& header = this->GetHeader();
    return { header.Places, this->Block + header.PointOffset };
  }

private:
  static constexpr std::uint16_t MostNumber = 0x1fffu;

  void ReadOtherGroup(std::uint32_t number, CellGroup& group) const
  {
    const CellBrickHeader& header = this->GetHeader();
    const std::byte* const heads = this->Block + header.GroupOffset;
    const CellGroupHead& head = reinterpret_cast<const CellGroupHead*>(heads)[number];
    const std::byte* bytes = heads + header.Groups * sizeof(CellGroupHead) + head.Offset;
    group.Cells = std::min(header.Cells - static_cast<int>(number) * CellBrickHeader::GroupSize,
      CellBrickHeader::GroupSize);
    group.Points = head.New + head.Old;
    for (int point = 0; point < head.New; ++point)
    {
      group.Numbers[point] = static_cast<std::uint16_t>(head.FirstNew + point);
    }
    if (group.Corners == CellGroup::MostCorners)
    {
      std::memcpy(group.Splits, bytes, static_cast<std::size_t>(group.Cells));
      bytes += group.Cells;
    }
    const int bits = head.GetBitsOfCorner();
    const std::uint64_t mask = (1u << bits) - 1u;
    std::size_t bit = 0;
    for (int cell = 0; cell < group.Cells; ++cell)
    {
      std::uint64_t word = ReadBits(bytes, bit);
      for (int corner = 0; corner < group.Corners; ++corner, word >>= bits)
      {
        group.At[cell][corner] = static_cast<std::uint8_t>(word & mask);
      }
      bit += static_cast<std::size_t>(group.Corners * bits);
    }
    const int bitsOfPoint = header.GetBitsOfPoint();
    const std::uint64_t maskOfPoint = (1u << bitsOfPoint) - 1u;
    for (int point = head.New; point < group.Points; ++point)
    {
      group.Numbers[point] = static_cast<std::uint16_t>(ReadBits(bytes, bit) & maskOfPoint);
      bit += static_cast<std::size_t>(bitsOfPoint);
    }
  }

  void ReadGroupOfGrid(std::uint32_t number, CellGroup& group) const
  {
    const CellBrickHeader& header = this->GetHeader();
    std::uint32_t groups[3];
    GetGroupsOfGrid(header.GridCells, groups);
    const std::uint32_t first[3] = { number % groups[0] * 2u, number / groups[0] % groups[1] * 2u,
      number / (groups[0] * groups[1]) * 2u };
    std::uint32_t cells[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      cells[axis] = std::min(header.GridCells[axis] - first[axis], 2u);
    }
    const std::uint32_t row = header.GridCells[0] + 1u;
    const std::uint32_t slice = row * (header.GridCells[1] + 1u);
    group.Points = 0;
    for (std::uint32_t z = first[2]; z <= first[2] + cells[2]; ++z)
    {
      for (std::uint32_t y = first[1]; y <= first[1] + cells[1]; ++y)
      {
        for (std::uint32_t x = first[0]; x <= first[0] + cells[0]; ++x)
        {
          group.Numbers[group.Points++] = static_cast<std::uint16_t>(x + row * y + slice * z);
        }
      }
    }
    const auto* const splits = reinterpret_cast<const SplitCode*>(this->Block + header.SplitOffset);
    const std::uint32_t rowOfGroup = cells[0] + 1u;
    const std::uint32_t sliceOfGroup = rowOfGroup * (cells[1] + 1u);
    group.Cells = 0;
    for (std::uint32_t z = 0; z < cells[2]; ++z)
    {
      for (std::uint32_t y = 0; y < cells[1]; ++y)
      {
        for (std::uint32_t x = 0; x < cells[0]; ++x)
        {
          const SplitCode split = splits[first[0] + x +
            header.GridCells[0] * (first[1] + y + header.GridCells[1] * (first[2] + z))];
          if (split == CellBrickHeader::Hidden)
          {
            continue;
          }
          group.Splits[group.Cells] = split;
          std::uint8_t* const at = group.At[group.Cells++];
          const std::uint32_t lowest = x + rowOfGroup * y + sliceOfGroup * z;
          for (std::uint32_t corner = 0; corner < CellGroup::MostCorners; ++corner)
          {
            at[HexahedronCorner(static_cast<int>(corner))] = static_cast<std::uint8_t>(lowest +
              (corner & 1u) + rowOfGroup * (corner >> 1 & 1u) + sliceOfGroup * (corner >> 2));
          }
        }
      }
    }
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
  /// Returns whether all corners of a cell have values.
  bool HasValues(const CellGroup& group, int cell) const
  {
    const float* const values = this->GetValues();
    return std::none_of(group.At[cell], group.At[cell] + group.Corners,
      [&](std::uint8_t corner) { return std::isnan(values[group.Numbers[corner]]); });
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
