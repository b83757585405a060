// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellNeighbourhood_h
#define rt_CellNeighbourhood_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/layout/VoxelBrick.h"
#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/grid/IsovalueLevel.h"

#include <algorithm>

namespace rt
{

/// The 4 x 4 x 4 samples around a cell, less the isovalue: all that the gradient at its corners
/// needs. Their indices run from 0 at the cell's first corner minus one; those of the 3 x 3 x 3
/// cells around it alike.
class CellNeighbourhood
{
public:
  /// Returns whether a brick has all samples of the neighborhood, and no mask. `cell` is in brick
  /// indices.
  template <class T>
  static bool IsWithin(const bricks::VoxelBrick<T>& brick, const int cell[3])
  {
    return brick.GetHeader().MaskOffset == 0 && cell[0] >= 1 && cell[1] >= 1 && cell[2] >= 1 &&
      cell[0] + 2 <= brick.GetCells(0) && cell[1] + 2 <= brick.GetCells(1) &&
      cell[2] + 2 <= brick.GetCells(2);
  }
  /// Before any CopyPart of a lattice without mask: all cells are covered that the volume has.
  /// `cell` is the volume's.
  void CoverWithin(const bricks::Index3& cell, const bricks::Index3& cells);

  /// Before any CopyPart of a lattice with mask: no cell is known to be covered.
  void Clear() { std::fill_n(this->Covered, 27, false); }

  /// Adds what a brick has of it; `cell` is in the brick's coordinates, but may lie outside of it.
  template <class T>
  void CopyPart(
    const bricks::VoxelBrick<T>& brick, const int cell[3], const IsovalueLevel<T>& level)
  {
    int first[3];
    int last[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      first[axis] = std::max(cell[axis] - 1, 0);
      last[axis] = std::min(cell[axis] + 2, brick.GetCells(axis));
      if (first[axis] >= last[axis])
      {
        return;
      }
    }
    for (int z = first[2]; z <= last[2]; ++z)
    {
      for (int y = first[1]; y <= last[1]; ++y)
      {
        const T* row = brick.GetSamples() + brick.GetOffset(0, y, z);
        double* out = this->Samples + 4 * (y - cell[1] + 1 + 4 * (z - cell[2] + 1));
        for (int x = first[0]; x <= last[0]; ++x)
        {
          out[x - cell[0] + 1] = level.Subtract(row[x]);
        }
      }
    }
    if (brick.GetHeader().MaskOffset == 0)
    {
      return;
    }
    for (int z = first[2]; z < last[2]; ++z)
    {
      for (int y = first[1]; y < last[1]; ++y)
      {
        bool* out = this->Covered + 3 * (y - cell[1] + 1 + 3 * (z - cell[2] + 1));
        for (int x = first[0]; x < last[0]; ++x)
        {
          out[x - cell[0] + 1] = brick.IsCovered(x, y, z);
        }
      }
    }
  }

  /// Numbers at the two corners of a row, lower x first.
  using Pair = Lanes::Half;
  /// The trilinear interpolation of numbers at the corners, in rows [z][y].
  static double Interpolate(const Pair rows[2][2], const Lanes& local)
  {
    const auto mix = [](const auto& a, const auto& b, double u) { return (1.0 - u) * a + u * b; };
    const Pair front = mix(rows[0][0], rows[1][0], local[2]);
    const Pair back = mix(rows[0][1], rows[1][1], local[2]);
    const Pair row = mix(front, back, local[1]);
    return mix(row[0], row[1], local[0]);
  }

  /// The gradient, in index space, at a point of the cell: trilinear between those at the corners,
  /// hence continuous across cells. At the corners it is the central difference; one-sided at the
  /// border of the volume, and next to samples that are missing or not finite. `Steps`: UnitSteps or CellSteps.
  template <class Steps>
  void GetGradient(const Lanes& local, const Steps& steps, double gradient[3]) const;

private:
  /// The derivative along an axis at the sample with the given place in Samples. The fast form
  /// assumes that both neighbors are there.
  template <class Steps>
  double GetCarefulDifference(const Steps& steps, int axis, int x, int y, int z) const;
  bool IsEdgeCovered(int axis, int x, int y, int z) const;

  double Samples[64];
  bool Covered[27];
};

} // namespace rt

#endif
