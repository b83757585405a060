// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_VoxelBrickHeader_h
#define bricks_VoxelBrickHeader_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ScalarType.h"
#include "DSMCore/base/Block.h"

#include <cstdint>

namespace bricks
{

/// Macrocells inside a brick are cubes of this many cells, the last ones of a row smaller.
constexpr int MacrocellEdge = 4;
/// Parts of a brick are cubes of this many cells, the last ones of a row smaller.
constexpr int PartEdge = 4 * MacrocellEdge;

/// Header of a voxel brick's block. Layout of the block, in this order:
///
///   this header                                64 bytes
///   macrocells: Min, Max in the sample type    x fastest; Min > Max where no cell holds data
///   bends of macrocells, then of parts         a byte each, see BrickBends.h
///   cell mask, only where the lattice has one  one bit a cell, x fastest, low bit first, set where
///                                              the cell holds data
///   samples in the sample type                 x fastest, (cells + 1) per axis, no padding
///
/// Every part starts at a multiple of BlockAlignment. Where the samples are of cells
/// (BrickLattice::IsOfCells), macrocells, bends and range are left empty.
struct VoxelBrickHeader
{
  std::uint32_t BlockBytes;
  std::uint16_t Cells[3];
  std::uint16_t Macrocells[3];
  std::uint32_t MaskOffset; ///< 0 when there is no mask
  std::uint32_t SampleOffset;
  /// Smallest and largest value of the cells that hold data, rounded outward; First > Last when no
  /// cell does.
  float First;
  float Last;
  ScalarType Type;
  /// For bricks of levels: where smaller or larger cells are next to cells that hold data. Bit 2 axis is the
  /// brick's lower side, bit 2 axis + 1 the upper one; InnerBorder is within the brick.
  std::uint8_t Borders;
  std::uint8_t Unused[2];
  std::uint32_t BendOffset;
  std::uint8_t Reserved[24];

  static constexpr std::uint8_t InnerBorder = 64;

  static constexpr std::uint32_t MacrocellOffset = 64;
};

static_assert(sizeof(VoxelBrickHeader) == VoxelBrickHeader::MacrocellOffset &&
    VoxelBrickHeader::MacrocellOffset % dsm::BlockAlignment == 0,
  "the macrocells follow the header");

/// The layout of a brick of `cells` (at most BrickLattice::LargestEdge per axis), without its range.
inline VoxelBrickHeader CreateVoxelBrickHeader(const Index3& cells, ScalarType type, bool cellMask)
{
  const auto align = [](std::uint64_t offset)
  { return (offset + dsm::BlockAlignment - 1) / dsm::BlockAlignment * dsm::BlockAlignment; };
  VoxelBrickHeader header{};
  header.Type = type;
  std::uint64_t macrocells = 1;
  std::uint64_t parts = 1;
  std::uint64_t samples = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    header.Cells[axis] = static_cast<std::uint16_t>(cells[axis]);
    header.Macrocells[axis] =
      static_cast<std::uint16_t>((cells[axis] + MacrocellEdge - 1) / MacrocellEdge);
    macrocells *= header.Macrocells[axis];
    parts *= static_cast<std::uint64_t>((cells[axis] + PartEdge - 1) / PartEdge);
    samples *= static_cast<std::uint64_t>(cells[axis] + 1);
  }
  std::uint64_t offset =
    VoxelBrickHeader::MacrocellOffset + macrocells * 2 * bricks::GetBytes(type);
  header.BendOffset = static_cast<std::uint32_t>(offset);
  offset = align(offset + macrocells + parts);
  if (cellMask)
  {
    header.MaskOffset = static_cast<std::uint32_t>(offset);
    offset = align(offset + (static_cast<std::uint64_t>(cells.x * cells.y * cells.z) + 7) / 8);
  }
  header.SampleOffset = static_cast<std::uint32_t>(offset);
  header.BlockBytes = static_cast<std::uint32_t>(align(offset + samples * bricks::GetBytes(type)));
  return header;
}

} // namespace bricks

#endif
