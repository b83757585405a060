// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMIsosurfaceGeometry_h
#define vtkPVDSMIsosurfaceGeometry_h

#include "vtkSmartPointer.h"

class vtkDSMVolumeMapper;
class vtkMultiBlockDataSet;

/// The triangles of the isosurfaces of this rank's data, for selections: they know the cells that they
/// are in, and the nearest points.
class vtkPVDSMIsosurfaceGeometry
{
public:
  /// More cells than that would make more triangles than a rank should hold for a selection.
  static constexpr long long MostCells = 1LL << 27;

  /// Null where there is nothing, or too much, which is reported as the mapper's error. Triangles of
  /// ghost and hidden cells are left out.
  static vtkSmartPointer<vtkMultiBlockDataSet> Make(vtkDSMVolumeMapper* mapper);
};

#endif
