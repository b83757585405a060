// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_LatticePlan_h
#define bricks_LatticePlan_h

#include "DSMBricks/base/Box.h"
#include "DSMBricks/layout/GridPlanes.h"

#include <glm/mat4x4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <vector>

namespace bricks
{

/// Placement of one piece of image data or of a rectilinear grid; plain, for messages between ranks.
struct PieceInfo
{
  /// Hash of the coordinates of a rectilinear piece, whose Origin, Spacing and Direction mean nothing; 0: image data.
  std::uint64_t Coordinates;
  double Origin[3]; ///< world position of index (0, 0, 0), as vtkImageData's
  double Spacing[3];
  double Direction[9]; ///< row-major
  /// Cells without ghosts, in the piece's own indices; empty on an axis with a single point.
  std::int64_t Min[3];
  std::int64_t Max[3];
  /// Number of the block of a composite dataset; pieces of one block are parts of one image.
  std::int32_t Leaf;
  /// Some cells within the box hold no data.
  std::int32_t HasMask;
};

/// Finds which pieces, of all ranks, continue one another: pieces on the same sampling points that touch form one
/// lattice, unless they are of blocks that are to stay apart. Rectilinear pieces are on the same points where all
/// their coordinates are equal in the ranges that they share. Points may differ by a small part of a cell; the ones
/// of the lowest block count. The result depends on the blocks' numbers, and on the order of the pieces of one
/// block.
class LatticePlan
{
public:
  struct Member
  {
    int Piece;             ///< index into the pieces
    Index3 IndexToLattice; ///< add to a piece's own index
    Box Cells;             ///< in lattice indices, which start at 0
  };
  struct Lattice
  {
    Index3 Points;
    glm::dmat4 IndexToWorld; ///< from grid space, if there are Planes
    /// Of rectilinear pieces; else null.
    std::shared_ptr<const GridPlanes> Planes;
    std::vector<Member> Members;
  };

  LatticePlan() = default;
  /// Throws dsm::Error when there are pieces, but none has a cell, and when one that has is at no place: its
  /// spacing is 0, or a number of spacing, origin or direction is not finite, or its coordinates do not rise or
  /// fall everywhere. `apart`: blocks that join no other. `coordinates`: of the points around the cells of each
  /// piece, which may be left out if none is rectilinear.
  explicit LatticePlan(const std::vector<PieceInfo>& pieces,
    const std::set<std::int32_t>& apart = {},
    const std::vector<GridPlanes::Coordinates>& coordinates = {});

  const std::vector<Lattice>& GetLattices() const { return this->Lattices; }

  /// Points that pieces of two blocks share in one lattice.
  struct Seam
  {
    std::size_t Lattice;
    std::array<std::size_t, 2> Members; ///< members of the lattice
    Box Points;                         ///< in lattice indices
  };
  std::vector<Seam> FindSeams(const std::vector<PieceInfo>& pieces) const;

  /// Returns whether every cell of `box` lies in one of `parts`.
  static bool IsCovered(const Box& box, const std::vector<Box>& parts);

private:
  std::vector<Lattice> Lattices;
};

} // namespace bricks

#endif
