// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_BrickLattice_h
#define bricks_BrickLattice_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/base/ScalarType.h"
#include "DSMCore/publish/BlockDirectory.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace bricks
{

/// How a volume is cut into bricks: cubes of `edge` cells on one lattice that starts at point 0 and
/// does not depend on the rank count. Neighboring bricks share the samples on their common face,
/// so no cell spans two bricks. Index order is x fastest everywhere; ids too.
class BrickLattice
{
public:
  /// The largest edge; keeps a block's size within 32 bits.
  static constexpr int LargestEdge = 256;

  BrickLattice() = default;
  /// `points`: samples per axis, each >= 2. `cellMask`: bricks carry a mask of cells without data.
  /// Throws dsm::Error when the points or the edge are out of bounds.
  BrickLattice(const Index3& points, ScalarType type, bool cellMask);
  BrickLattice(const Index3& points, ScalarType type, bool cellMask, int edge);

  /// The brick edge in cells that makes blocks of about the paper's 32 KB.
  static int GetDefaultEdge(ScalarType type);

  /// Returns whether both divide volumes into the same bricks.
  bool operator==(const BrickLattice& other) const
  {
    return this->Points == other.Points && this->Type == other.Type &&
      this->CellMask == other.CellMask && this->CellValues == other.CellValues &&
      this->Edge == other.Edge;
  }

  const Index3& GetPoints() const { return this->Points; }
  Index3 GetCells() const { return this->Points - Index3(1); }
  ScalarType GetScalarType() const { return this->Type; }
  bool HasCellMask() const { return this->CellMask; }

  /// The same for values of cells instead of points: the sample at point (i, j, k) is the value of cell
  /// (i, j, k), and the last ones on each axis have no meaning.
  BrickLattice OfCells() const
  {
    BrickLattice lattice = *this;
    lattice.CellValues = true;
    return lattice;
  }
  bool IsOfCells() const { return this->CellValues; }
  int GetEdge() const { return this->Edge; }
  const Index3& GetBricks() const { return this->Bricks; }
  dsm::BlockId GetBrickCount() const;

  dsm::BlockId GetId(const Index3& brick) const
  {
    return static_cast<dsm::BlockId>(
      brick.x + this->Bricks.x * (brick.y + this->Bricks.y * brick.z));
  }
  Index3 GetBrick(dsm::BlockId id) const;
  /// The cells of a brick, clipped to the volume.
  Box GetCellsOfBrick(dsm::BlockId id) const;
  /// The brick that a point of index space lies in; the nearest one for a point outside.
  dsm::BlockId FindBrick(const glm::dvec3& point) const;
  std::uint32_t GetBlockBytes(dsm::BlockId id) const;
  /// Bricks dealt one by one, or as `assigner` deals them.
  dsm::BlockDirectory CreateDirectory(int ranks) const;
  dsm::BlockDirectory CreateDirectory(const dsm::BlockAssigner& assigner) const;

private:
  Index3 Points{ 2 };
  Index3 Bricks{ 1 };
  ScalarType Type = ScalarType::Float32;
  bool CellMask = false;
  bool CellValues = false;
  int Edge = 16;
};

} // namespace bricks

#endif
