// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMCellPiece_h
#define vtkDSMCellPiece_h

#include "DSMBricks/base/ValidValues.h"
#include "DSMBricks/build/CellReader.h"
#include "DSMBricks/build/LatticePlan.h"
#include "vtkDSMCellMask.h"

#include "vtkSmartPointer.h"

#include <optional>
#include <vector>

class vtkDSMImagePiece;
class vtkDataArray;
class vtkDataSet;

/// A cell array of one vtkDataSet of this rank: of one component, or of all those that a magnitude or a color is made
/// of. Copies nothing.
class vtkDSMCellPiece final : public bricks::CellReader
{
public:
  /// `component`: see vtkDSMImagePiece; `hasMask`: its PieceInfo's, or there is a mask. Cells with a missing value, or
  /// hidden by the mask (may be none), hold no data.
  vtkDSMCellPiece(vtkDataSet* image, vtkDataArray* array, int component,
    const bricks::LatticePlan::Member& place, bool hasMask, const bricks::ValidValues& valid = {},
    std::optional<vtkDSMCellMask> mask = {});
  ~vtkDSMCellPiece() override;

  bricks::Box GetCells() const override;
  bricks::Box GetReach() const override;
  bool HasMask() const override { return this->Masked; }
  void ReadStates(const bricks::Box& cells, std::uint8_t* out) const override;
  int CountComponents() const override;
  bricks::ScalarType GetType() const override;
  void ReadValues(int component, const bricks::Box& cells, std::byte* out) const override;
  void Combine(std::size_t count, const std::byte* values, std::byte* samples) const override;

private:
  vtkSmartPointer<vtkDataArray> Array;
  int Component;
  bool Masked;
  bricks::ValidValues Valid;
  std::optional<vtkDSMCellMask> Mask;
  std::vector<vtkDSMImagePiece> Parts; ///< one a component
};

#endif
