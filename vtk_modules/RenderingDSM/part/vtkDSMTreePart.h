// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMTreePart_h
#define vtkDSMTreePart_h

#include "DSMBricks/base/Box.h"
#include "vtkDSMLevelPart.h"

#include <memory>
#include <optional>
#include <set>
#include <vector>

class vtkHyperTreeGrid;

/// Hyper tree grids in three dimensions, whose roots are on one lattice, equally spaced. Masked and ghost cells are
/// not shown.
class vtkDSMTreePart final : public vtkDSMLevelPart
{
public:
  /// Collective. `pieces`: this rank's hyper tree grids, which Join has put together.
  vtkDSMTreePart(const std::shared_ptr<vtkDSMRankGroup>& group, const OwnPieces& pieces);
  ~vtkDSMTreePart() override;

  /// Collective. Returns this rank's grids sorted into those that are one; some have none on this rank. Grids whose
  /// roots are on one lattice are one if they are pieces of the same dataset, or if there is no root where several
  /// have a tree.
  static std::vector<OwnPieces> Join(dsm::Messenger& messenger, const OwnPieces& pieces);

private:
  class Source;
  /// Where a grid's roots are; plain, for messages between ranks.
  struct Roots
  {
    double Origin[3];
    double Spacing[3];
    std::int64_t Cells[3];
    std::int64_t Branching;
    std::int64_t Levels;
    bricks::Box Trees;    ///< around the roots that have a tree
    std::int64_t Dataset; ///< see Piece
    vtkDSMBlockLook Look;
  };
  static Roots Describe(const Piece& piece);
  /// Finds where the first root of a grid is on the lattice of another one's. Nothing where it is not on it.
  static std::optional<bricks::Index3> FindFirst(const Roots& roots, const Roots& other);
  void Place(const std::vector<Roots>& all, int firstOwn);
  /// Collective. Some sources make trees on several ranks when they are asked for ghost cells, and do not mark
  /// them. The first of equal trees counts.
  void FindRepeated(int firstOwn);

  void AddPlaces(bricks::ByteHash& hash) const override;
  std::unique_ptr<vtkDSMLevelSource> CreateSource(const Choice& choice) const override;

  std::vector<vtkSmartPointer<vtkHyperTreeGrid>> Grids;
  std::vector<bricks::Index3> FirstRoots;    ///< of this rank's grids, among those of all
  std::vector<std::set<vtkIdType>> Repeated; ///< trees of this rank's grids that do not count
};

#endif
