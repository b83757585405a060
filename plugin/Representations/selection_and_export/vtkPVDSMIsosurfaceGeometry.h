// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMIsosurfaceGeometry_h
#define vtkPVDSMIsosurfaceGeometry_h

#include "vtkSmartPointer.h"

#include <vector>

class vtkDSMScene;
class vtkDSMVolumeMapper;
class vtkDataObject;
class vtkMultiBlockDataSet;
class vtkPolyData;

/// The triangles of the isosurfaces in this rank's data: see vtkDSMScene::ExtractIsosurfaces, which reports what fails.
/// Collective.
class vtkPVDSMIsosurfaceGeometry
{
public:
  /// For selections; empty if that fails. Cells and points of images are counted in `source`, from which the
  /// mapper's data came: since then, another filter may have asked it for more ghost cells. May be null.
  static vtkSmartPointer<vtkMultiBlockDataSet> Make(
    vtkDSMScene* scene, vtkDSMVolumeMapper* mapper, vtkDataObject* source);

  /// For exports; those of blocks that look alike together, with a vtkPVDSMExportLook.
  static std::vector<vtkSmartPointer<vtkPolyData>> MakeColored(
    vtkDSMScene* scene, vtkDSMVolumeMapper* mapper);
};

#endif
