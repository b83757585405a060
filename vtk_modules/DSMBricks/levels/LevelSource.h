// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_LevelSource_h
#define bricks_LevelSource_h

#include "DSMBricks/levels/LevelLattice.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bricks
{

/// The leaves that one rank has, with their values. Implemented over VTK's AMR and hyper tree grids. Reading is safe from one
/// thread at a time.
class LevelSource
{
public:
  virtual ~LevelSource() = default;

  /// The cubes in which this rank has leaves, each once.
  virtual const std::vector<LevelCube>& GetCubes() const = 0;

  /// Returns whether values are of points, the corners of leaves, and not of cells.
  virtual bool IsOfPoints() const = 0;

  /// Reads cube `number` of GetCubes. `isLeaf`: one byte a cell of the cube, Edge^3, x fastest; set to 1 for this rank's
  /// leaves and to 0 elsewhere. `values`: of the cells likewise, or of the points, (Edge + 1)^3; what belongs to no leaf is
  /// left as it is.
  virtual void ReadCube(std::size_t number, double* values, std::uint8_t* isLeaf) const = 0;
};

} // namespace bricks

#endif
