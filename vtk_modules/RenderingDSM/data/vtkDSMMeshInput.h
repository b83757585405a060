// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMeshInput_h
#define vtkDSMMeshInput_h

#include "vtkDSMMeshBlock.h"
#include "vtkDSMMeshPiece.h"

#include "vtkMapper.h"

#include <string>
#include <vector>

class vtkCompositeDataDisplayAttributes;

/// Surfaces as a mapper has them, and what it asks for.
struct vtkDSMMeshInput
{
  /// Whose dataset and settings of colours are read, and who tells of progress.
  vtkMapper* Mapper = nullptr;
  /// Of the dataset's blocks; may be null.
  vtkCompositeDataDisplayAttributes* BlockAttributes = nullptr;
  /// As vtkDSMPolyDataMapper has them.
  double LineRadius = 0.0;
  double PointRadius = 0.0;
  std::string RadiusArray;
  vtkDSMMeshWish Wish;

  /// This rank's part of the dataset, or null.
  vtkDataObject* GetData() const
  {
    return this->Mapper->GetNumberOfInputConnections(0) > 0 ? this->Mapper->GetInputDataObject(0, 0)
                                                            : nullptr;
  }
  /// Of this rank, in order; as vtkDSMMeshBlock::Collect.
  std::vector<vtkDSMMeshBlock> CollectBlocks() const
  {
    return vtkDSMMeshBlock::Collect(this->GetData(), this->BlockAttributes);
  }
};

#endif
