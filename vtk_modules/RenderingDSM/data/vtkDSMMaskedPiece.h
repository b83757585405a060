// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMaskedPiece_h
#define vtkDSMMaskedPiece_h

#include "DSMBricks/build/VoxelSource.h"
#include "vtkDSMCellMask.h"

#include <memory>
#include <utility>

/// A piece of a lattice without the cells that a mask hides.
class vtkDSMMaskedPiece final : public bricks::VoxelSource
{
public:
  vtkDSMMaskedPiece(std::shared_ptr<const bricks::VoxelSource> piece, vtkDSMCellMask mask)
    : Piece(std::move(piece))
    , Mask(std::move(mask))
  {
  }

  bricks::Box GetCells() const override { return this->Piece->GetCells(); }
  void ReadSamples(const bricks::Box& points, std::byte* out) const override
  {
    this->Piece->ReadSamples(points, out);
  }
  bool HasCellMask() const override { return true; }
  void ReadCellMask(const bricks::Box& cells, std::uint8_t* out) const override
  {
    this->Piece->ReadCellMask(cells, out);
    this->Mask.Apply(cells, out);
  }

private:
  std::shared_ptr<const bricks::VoxelSource> Piece;
  vtkDSMCellMask Mask;
};

#endif
