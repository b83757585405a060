// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMLatticePart_h
#define vtkDSMLatticePart_h

#include "DSMBricks/build/LatticePlan.h"
#include "DSMBricks/build/VoxelSource.h"
#include "vtkDSMFileVolume.h"
#include "vtkDSMPart.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <string>
#include <vector>

class vtkDataSet;

/// Images, or rectilinear grids, that continue one another: values at the points of one lattice, or in its cells.
class vtkDSMLatticePart final : public vtkDSMPart
{
public:
  /// An image of any rank.
  struct Piece
  {
    bricks::PieceInfo Info;
    vtkDSMBlockLook Look;
    vtkSmartPointer<vtkDataSet> Image; ///< null: it is another rank's
  };

  /// Local, the same on every rank. `pieces`: in rank order; the lattice's members are numbered by their index here.
  vtkDSMLatticePart(std::shared_ptr<vtkDSMRankGroup> group, bricks::LatticePlan::Lattice lattice,
    std::vector<Piece> pieces);
  ~vtkDSMLatticePart() override;

  void AddContent(const Choice& choice, bricks::ByteHash& hash) const override;
  std::vector<Info> FindArrays(const Choice& choice) const override;
  std::shared_ptr<vtkDSMPartValues> Publish(const Request& request, const std::vector<Info>& infos,
    std::shared_ptr<vtkDSMPartValues> old) const override;
  bool MayTakeOver(const vtkDSMPartValues& old) const override;
  std::shared_ptr<vtkDSMPartValues> PublishCoarser(
    const vtkDSMPartValues& finest, int level, const Request& request) const override;
  Boxed PublishBoxes(const vtkDSMPartValues& finest, const vtkDSMNestedLevels::Boxes& boxes,
    const Request& request, const Boxed& old) const override;
  OwnCells FindOwnCells(const vtkDSMPartValues& values, const Choice& choice) const override;

private:
  using Sources = std::vector<std::shared_ptr<const bricks::VoxelSource>>;
  class Values;

  /// Local: a member's image, if it is this rank's; else null.
  vtkDataSet* FindOwn(const bricks::LatticePlan::Member& member) const
  {
    return this->Pieces[static_cast<std::size_t>(member.Piece)].Image;
  }
  /// Returns the values of this rank's first piece if it has the array in a file; else null.
  const vtkDSMFileValues* FindFileValues(const Choice& choice) const;
  /// Collective: the file that has all of the values, or null. `type`: of the values.
  std::unique_ptr<vtkDSMFileVolume> FindFile(const Request& request, const std::vector<Info>& infos,
    const bricks::BrickLattice& lattice) const;
  /// Collective: the lattice is in a file. Its bricks come to memory when rays meet them. `old`: what is there of
  /// another step, or null; bricks that are equal stay in memory.
  void PublishFile(const vtkDSMFileVolume& file, bool isCoarser, const Request& request,
    const std::string& what, Values& values, std::shared_ptr<Values> old) const;
  /// Collective: the values of a lattice in a file, or of the finest of its levels that is small enough. `values`:
  /// without bricks.
  std::shared_ptr<Values> PublishLevel(std::shared_ptr<const vtkDSMFileVolume> file,
    const Request& request, std::shared_ptr<Values> values, std::shared_ptr<Values> old) const;
  /// Collective: the bricks of a level's box.
  std::shared_ptr<bricks::VoxelField> PublishBox(const Values& finest,
    const vtkDSMNestedLevels::Boxes& boxes, int level, const Request& request) const;
  /// Collective: what a coarser level says about the values of a file without an index. The bricks of that level are
  /// not published.
  std::shared_ptr<const bricks::VoxelField> LookAtCoarser(const vtkDSMFileVolume& file,
    const bricks::BrickLattice& lattice, const Request& request) const;
  /// Collective: the old bricks, with what the pieces hold now.
  void Renew(Values& values, Values& old, const Sources& pieces, const Request& request) const;
  /// Local. Values in a field of such bricks, which leaves the store with its last user.
  std::shared_ptr<Values> MakeValues(
    const bricks::BrickLattice& lattice, const glm::dmat4& indexToData) const;
  /// Local. The field without its bricks; null where no piece has the array.
  std::shared_ptr<Values> CreateValues(
    const Request& request, const std::vector<Info>& infos) const;
  /// Local. Returns whether some cells have no value in an array, whatever the values are.
  bool HasGaps(const std::vector<Info>& infos) const;
  /// Local. This rank's pieces.
  Sources CreateSources(const bricks::BrickLattice& bricks, const Choice& choice) const;
  /// Collective. The same for averages of cells, which other pieces have a part in. `infos`: of all ranks' pieces.
  Sources AverageCells(const Request& request, const std::vector<Info>& infos) const;

  bricks::LatticePlan::Lattice Lattice;
  std::vector<Piece> Pieces;
};

#endif
