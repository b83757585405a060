// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_PacketBrick_h
#define rt_PacketBrick_h

#include "DSMBricks/layout/VoxelBrickHeader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rt
{

/// Data about 4 x 4 x 4 macrocells of a brick. Bit (or index) x + 4 y + 16 z stands for a macrocell
/// of the part, or for a cell of the macrocell, counted in the order of NodeOrder.
struct PacketPart
{
  std::uint64_t Macrocells; ///< those that may hold the surface
  std::uint64_t Known;      ///< those whose Cells are valid
  std::uint64_t Cells[64];  ///< for each macrocell: its cells that have corners on both sides
};

/// Queries of a packet about a brick and an isovalue, independent of the type of the samples.
/// Coordinates are brick indices.
class PacketBrick
{
public:
  virtual int GetMacrocells(int axis) const = 0;
  virtual int GetCells(int axis) const = 0;

  /// The macrocells from 4 part on. Valid until the next call.
  virtual const PacketPart& FindPart(const int part[3]) const = 0;

  /// Adds the cells of a macrocell of the part that FindPart was last called for.
  virtual void FindCells(const int part[3], int macrocell) const = 0;

  /// For each of `rays`, which is in the cell with the coordinates cell[axis * stride + ray]: the
  /// corners less the isovalue, `stride` numbers from one to the next, those of a ray from
  /// `corners` + ray on. Returns the rays whose cells hold data.
  virtual unsigned GetCorners(
    unsigned rays, const double* cell, double* corners, int stride) const = 0;

  /// Samples that can be read without asking.
  struct FloatSamples
  {
    const float* First = nullptr; ///< null: ask GetCorners
    double Row = 0.0;             ///< samples to the next one on y, and on z
    double Slice = 0.0;
    double Isovalue = 0.0;
  };
  FloatSamples Floats;

  /// Returns whether a cell has data. Its coordinates may lie outside of the brick.
  virtual bool HasCell(const int cell[3]) const = 0;

  /// For bricks of levels, next to cells of another size: values there agree but for the rounding of samples, so a ray
  /// could slip through between a value that is just above the isovalue and one that is just below.
  struct LevelBorder
  {
    std::uint8_t Sides = 0; ///< VoxelBrickHeader::Borders
    double Isovalue = 0.0;
    double Rounding = 0.0; ///< of a value of 1
    double Largest = 0.0;  ///< value of the brick

    /// Returns whether that is where a ray leaves the cell, which has no crossing. `corners` and `end`: as in
    /// VoxelCrossing, `value`: where the ray leaves; it is less than the rounding of Largest.
    bool MayHide(const PacketBrick& brick, const double corners[8], const int cell[3],
      const double end[3], const bool forward[3], double value) const;
  };
  LevelBorder Border;

protected:
  ~PacketBrick() = default;
};

inline bool PacketBrick::LevelBorder::MayHide(const PacketBrick& brick, const double corners[8],
  const int cell[3], const double end[3], const bool forward[3], double value) const
{
  double largest = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    largest = std::max(largest, std::abs(corners[corner] + this->Isovalue));
  }
  if (std::abs(value) > this->Rounding * largest)
  {
    return false;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    if (end[axis] != (forward[axis] ? 1.0 : 0.0))
    {
      continue;
    }
    int next[3] = { cell[0], cell[1], cell[2] };
    next[axis] += forward[axis] ? 1 : -1;
    const bool isInside = next[axis] >= 0 && next[axis] < brick.GetCells(axis);
    const int bit =
      isInside ? bricks::VoxelBrickHeader::InnerBorder : 1 << (2 * axis + (forward[axis] ? 1 : 0));
    if ((this->Sides & bit) != 0 && !brick.HasCell(next))
    {
      return true;
    }
  }
  return false;
}

} // namespace rt

#endif
