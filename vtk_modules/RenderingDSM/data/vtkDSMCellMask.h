// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMCellMask_h
#define vtkDSMCellMask_h

#include "DSMBricks/build/LatticePlan.h"
#include "vtkDSMImageArrays.h"
#include "vtkDSMImagePiece.h"

#include <cstdint>
#include <optional>
#include <vector>

class vtkDataSet;

/// The cells of an image that the values of a mask array show. Copies no values; safe from any thread while the image
/// is not modified.
class vtkDSMCellMask
{
public:
  /// The mask of a choice that has one. An image without the array shows no cell. `place`: see vtkDSMImagePiece.
  vtkDSMCellMask(vtkDataSet* image, const vtkDSMImageArrays::Choice& choice,
    const bricks::LatticePlan::Member& place);
  ~vtkDSMCellMask();

  /// Sets to 0 what `out` has of cells that are not shown: one byte a cell of `cells`, which may be ghost cells, in
  /// lattice indices, x fastest.
  void Apply(const bricks::Box& cells, std::uint8_t* out) const;

private:
  std::optional<vtkDSMImagePiece> Array; ///< none: it does not exist
  bricks::ScalarType Type = bricks::ScalarType::Float32;
  vtkDSMImageArrays::CellMask Shown; ///< its values ascend
};

#endif
