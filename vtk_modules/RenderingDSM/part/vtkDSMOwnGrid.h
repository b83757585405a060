// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMOwnGrid_h
#define vtkDSMOwnGrid_h

#include "vtkDataArray.h"
#include "vtkPointSet.h"
#include "vtkSmartPointer.h"

#include <cstdint>
#include <vector>

/// A grid of this rank with cells of any shape, of which VTK's own classes make isosurfaces as triangles.
struct vtkDSMOwnGrid
{
  vtkSmartPointer<vtkPointSet> Data;
  vtkSmartPointer<vtkDataArray> Values; ///< of the points; NaN: it has none
  std::vector<std::uint8_t> IsShown;    ///< of the cells; 0: not shown, or without a volume
};

#endif
