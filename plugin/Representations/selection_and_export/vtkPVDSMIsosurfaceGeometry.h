// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMIsosurfaceGeometry_h
#define vtkPVDSMIsosurfaceGeometry_h

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <vector>

class vtkDSMVolumeMapper;
class vtkDataObject;
class vtkMultiBlockDataSet;
class vtkPolyData;

/// Extracts the triangles of the isosurfaces of this rank's data. For selections, they have the ids of their
/// cells and of the nearest points; for exports, they have normals and the array that colors them. A small
/// part of the data is copied at a time: they may be in a file, and larger than the memory.
class vtkPVDSMIsosurfaceGeometry
{
public:
  /// Largest number of cells in a dataset from which ParaView extracts a selection; the extraction
  /// takes 10 bytes or more for each cell.
  static constexpr vtkIdType MostCellsOfSelection = vtkIdType(1) << 27;
  /// Largest number of triangles that a rank should hold at once, about 0.8 GiB.
  static constexpr vtkIdType MostTriangles = 10'000'000;

  /// Null where there is nothing, or too much, which is reported as the mapper's error. Triangles of
  /// ghost and hidden cells are left out. Cells and points are counted in `source`, from which the mapper's
  /// data came: since then, another filter may have asked it for more ghost cells. May be null.
  static vtkSmartPointer<vtkMultiBlockDataSet> Make(
    vtkDSMVolumeMapper* mapper, vtkDataObject* source);

  /// The same with the values of the color array, and normals; of blocks that look alike together, with a
  /// vtkPVDSMExportLook. Other data than images are reported as the mapper's error.
  static std::vector<vtkSmartPointer<vtkPolyData>> MakeColored(vtkDSMVolumeMapper* mapper);
};

#endif
