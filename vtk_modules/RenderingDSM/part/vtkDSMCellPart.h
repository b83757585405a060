// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMCellPart_h
#define vtkDSMCellPart_h

#include "DSMBricks/cells/CellBricks.h"
#include "vtkDSMGridCells.h"
#include "vtkDSMPart.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

class vtkPointSet;

/// Curvilinear and unstructured grids of all ranks that have one look. Their cells are put in bricks once, for all
/// arrays and for all parts of the same cells.
class vtkDSMCellPart final : public vtkDSMPart
{
public:
  struct Piece
  {
    vtkSmartPointer<vtkPointSet> Data; ///< has cells with a volume
    vtkDSMBlockLook Look = {};
  };
  using OwnPieces = std::vector<Piece>;

  /// Collective. `pieces`: this rank's. Pieces of the same look are one part.
  static std::vector<std::unique_ptr<vtkDSMPart>> Create(
    const std::shared_ptr<vtkDSMRankGroup>& group, const OwnPieces& pieces);
  ~vtkDSMCellPart() override;

  void AddContent(const Choice& choice, bricks::ByteHash& hash) const override;
  std::vector<Info> FindArrays(const Choice& choice) const override;
  /// An array of cells becomes one of points, by the mean of the cells around each point, also where it is to be shown
  /// cell by cell.
  std::shared_ptr<vtkDSMPartValues> Publish(const Request& request, const std::vector<Info>& infos,
    std::shared_ptr<vtkDSMPartValues> old) const override;
  /// Values of cells become those of points with what this rank has of cells, ghost cells included.
  OwnGrids FindOwnGrids(const Choice& choice) const override;

private:
  struct Cells;
  struct Inputs;

  /// Collective.
  vtkDSMCellPart(std::shared_ptr<vtkDSMRankGroup> group, vtkDSMGridCells::Grids grids,
    const vtkDSMBlockLook& look);
  std::uint64_t HashPlaces() const;
  /// Threads of this rank that read and build.
  int CountThreads() const { return this->Group->GetStore().GetSettings().Workers; }
  /// Throws dsm::Error for colors that are no numbers to interpolate.
  static void Refuse(const Choice& choice);
  /// Local. Throws dsm::Error.
  Inputs MakeInputs(const Choice& choice) const;
  /// Collective. Puts the cells in bricks, unless they are there.
  void RequireCells(const Request& request, const Inputs& inputs,
    const std::function<void(double)>& progress) const;
  /// Collective. The values at the points of this rank's grids.
  std::vector<float> AverageCells(const Request& request, const Inputs& inputs, const Cells& cells,
    const std::function<void(double)>& progress) const;
  /// Collective.
  std::shared_ptr<bricks::CellValues> PublishValues(const Request& request, const Inputs& inputs,
    const std::shared_ptr<const Cells>& cells, const std::function<void(double)>& progress) const;

  vtkDSMGridCells::Grids Own;
  std::uint64_t PlacesHash = 0; ///< of all that this rank's cells depend on
  /// Of this data or of earlier ones with the same cells; null before they are needed, and when memory was short.
  mutable std::shared_ptr<const Cells> Known;
};

#endif
