// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_LevelSource_h
#define bricks_LevelSource_h

#include "DSMBricks/levels/LevelLattice.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace bricks
{

/// Cubes, each once, in the order in which they were first asked for.
class LevelCubes
{
public:
  /// The number of the cube of a level that has a cell, which must not be negative. Adds one without leaves if
  /// there is none.
  std::size_t Find(int level, const Index3& cell);
  const std::vector<LevelCube>& GetAll() const { return this->All; }
  /// Counts a leaf of cube `number`; `cell`: of the level.
  void Count(std::size_t number, const Index3& cell)
  {
    this->All[number].Count(cell - GetFirst(this->All[number]));
  }
  /// The first cell of a cube, in cells of its level.
  static Index3 GetFirst(const LevelCube& cube)
  {
    return Index3(cube.Place[0], cube.Place[1], cube.Place[2]) * Index3(LevelLattice::Edge);
  }

private:
  std::vector<LevelCube> All;
  std::map<std::tuple<int, std::int64_t, std::int64_t, std::int64_t>, std::size_t> Numbers;
};

/// The leaves that one rank has, with their values. Implemented over VTK's AMR and hyper tree grids. Reading is
/// safe from one thread at a time.
class LevelSource
{
public:
  virtual ~LevelSource() = default;

  /// The cubes in which this rank has leaves, each once.
  virtual const std::vector<LevelCube>& GetCubes() const = 0;

  /// Returns whether values are of points, the corners of leaves, and not of cells.
  virtual bool IsOfPoints() const = 0;

  /// Reads cube `number` of GetCubes. `isLeaf`: one byte a cell of the cube, Edge^3, x fastest; set to 1 for this
  /// rank's leaves and to 0 elsewhere. `values`: of the cells likewise, or of the points, (Edge + 1)^3; what
  /// belongs to no leaf is left as it is.
  virtual void ReadCube(std::size_t number, double* values, std::uint8_t* isLeaf) const = 0;
};

} // namespace bricks

#endif
