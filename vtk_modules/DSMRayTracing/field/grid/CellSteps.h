// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellSteps_h
#define rt_CellSteps_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/layout/GridPlanes.h"

#include <algorithm>
#include <cstddef>

namespace rt
{

/// Reciprocals of the distances between the samples that differences at a cell's corners are made of: of a uniform
/// lattice.
struct UnitSteps
{
  /// From the sample before the lower (corner 0) or upper (1) plane of the cell to the one behind it.
  double GetCentral(int, int) const { return 0.5; }
  /// Along the cell before (-1), the cell itself (0), or the one behind it (1).
  double GetAlong(int, int) const { return 1.0; }
};

/// The same of a rectilinear grid, in grid space. Steps that leave the grid mean nothing.
class CellSteps
{
public:
  /// `cell`: its index in the grid.
  CellSteps(const bricks::GridPlanes& planes, const bricks::Index3& cell)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double* const places = planes.GetPlaces(axis);
      const double* const inverse = planes.GetInverseWidths(axis);
      const auto own = static_cast<std::size_t>(cell[axis]);
      const std::size_t before = own - std::min<std::size_t>(own, 1);
      this->Central[axis][0] = 1.0 / (places[own + 1] - places[before]);
      this->Central[axis][1] = 1.0 / (places[own + 2] - places[own]);
      this->Along[axis][0] = inverse[before];
      this->Along[axis][1] = inverse[own];
      this->Along[axis][2] = inverse[own + 1];
    }
  }

  double GetCentral(int axis, int corner) const { return this->Central[axis][corner]; }
  double GetAlong(int axis, int cell) const { return this->Along[axis][cell + 1]; }

private:
  double Central[3][2];
  double Along[3][3];
};

} // namespace rt

#endif
