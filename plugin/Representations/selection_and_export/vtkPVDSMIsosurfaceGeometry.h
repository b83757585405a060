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

/// The triangles of the isosurfaces of this rank's data. For selections, they know the cells that they are in, and the
/// nearest points; for exports, they have normals and what colours them. Of the data, a small part at a time is copied:
/// they may be in a file, and larger than the memory.
class vtkPVDSMIsosurfaceGeometry
{
public:
  /// Of a dataset from which ParaView then extracts what is selected: that takes 10 bytes and more for each of its cells.
  static constexpr vtkIdType MostCellsOfSelection = vtkIdType(1) << 27;
  /// What a rank should hold at once, about 0.8 GiB.
  static constexpr vtkIdType MostTriangles = 10'000'000;

  /// Null where there is nothing, or too much, which is reported as the mapper's error. Triangles of
  /// ghost and hidden cells are left out. Cells and points are counted in `source`, from which the mapper's
  /// data came: since then, another filter may have asked it for more ghost cells. May be null.
  static vtkSmartPointer<vtkMultiBlockDataSet> Make(
    vtkDSMVolumeMapper* mapper, vtkDataObject* source);

  /// The same with the values of the colour array, and normals; of blocks that look alike together, with a
  /// vtkPVDSMExportLook.
  static std::vector<vtkSmartPointer<vtkPolyData>> MakeColored(vtkDSMVolumeMapper* mapper);
};

#endif
