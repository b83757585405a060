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
  /// Mapper with the dataset and the settings of colors; it also reports progress.
  vtkMapper* Mapper = nullptr;
  /// Attributes of the dataset's blocks; may be null.
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
  /// Returns this rank's blocks, in order; see vtkDSMMeshBlock::Collect.
  std::vector<vtkDSMMeshBlock> CollectBlocks() const
  {
    return vtkDSMMeshBlock::Collect(this->GetData(), this->BlockAttributes);
  }
};

#endif
