// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMLevelPart_h
#define vtkDSMLevelPart_h

#include "DSMBricks/levels/LevelLattice.h"
#include "DSMBricks/levels/LevelSource.h"
#include "vtkDSMPart.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

class vtkDataObject;

/// The leaves that one rank has, and which cells of its pieces they are.
class vtkDSMLevelSource : public bricks::LevelSource
{
public:
  /// A cell of a piece.
  struct Cell
  {
    int Piece = -1; ///< index into the part's own pieces; -1: the cell is not a leaf of this rank
    vtkIdType Id = -1;
  };
  /// Reads which cells of this rank's pieces are the cells of cube `number` of GetCubes: Edge^3, x fastest.
  virtual std::vector<Cell> ReadCells(std::size_t number) const = 0;
};

/// Data whose cells are of several sizes that lie within one another, with one coarsest level in common.
class vtkDSMLevelPart : public vtkDSMPart
{
public:
  struct Piece
  {
    vtkSmartPointer<vtkDataObject> Data; ///< a hyper tree grid with cells, or an image of AMR
    /// Flat index of what it is a piece of, in the rank's composite dataset; 0 without one. Pieces
    /// of one hyper tree grid have the same on all ranks, and a block of AMR has its own.
    std::int64_t Dataset = 0;
    vtkDSMBlockLook Look = {};
  };
  using OwnPieces = std::vector<Piece>;

  /// Collective. `pieces`: this rank's. AMR is one part; hyper tree grids are one where their roots are on one
  /// lattice and do not overlap.
  static std::vector<std::unique_ptr<vtkDSMPart>> Create(
    const std::shared_ptr<vtkDSMRankGroup>& group, const OwnPieces& pieces);
  ~vtkDSMLevelPart() override;

  void AddContent(const Choice& choice, bricks::ByteHash& hash) const override;
  std::vector<Info> FindArrays(const Choice& choice) const override;
  /// An array of points that the pieces do not have is the array of cells of that name.
  std::shared_ptr<vtkDSMPartValues> Publish(const Request& request, const std::vector<Info>& infos,
    std::shared_ptr<vtkDSMPartValues> old) const override;
  OwnCells FindOwnCells(const vtkDSMPartValues& values, const Choice& choice) const override;

protected:
  /// Collective.
  vtkDSMLevelPart(std::shared_ptr<vtkDSMRankGroup> group, const OwnPieces& pieces);
  /// Local: this rank's leaves in the pieces that have an array, with its values.
  virtual std::unique_ptr<vtkDSMLevelSource> CreateSource(const Choice& choice) const = 0;
  /// Local: adds where this rank's cells are.
  virtual void AddPlaces(bricks::ByteHash& hash) const = 0;
  /// Sets the place of the coarsest level. `origin`: of its point (0, 0, 0).
  void SetPlace(const glm::dvec3& origin, const glm::dmat3& direction, const glm::dvec3& spacing);

  bricks::LevelScales Scales;

private:
  /// The array as the pieces have it.
  Choice Find(const Choice& choice) const;
  std::uint64_t HashPlaces() const;

  vtkDSMOwnCells::Datasets Own;
  vtkDSMImageArrays Arrays;
  mutable std::optional<std::uint64_t> PlacesHash; ///< set when it is first asked for
};

#endif
