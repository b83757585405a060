// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMExportSource_h
#define vtkPVDSMExportSource_h

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkPolyData;

/// A representation whose surfaces exporters and selections can have as triangles.
class vtkPVDSMExportSource
{
public:
  virtual ~vtkPVDSMExportSource() = default;

  /// Local: what is shown of this rank's data, in the dataset's coordinates; empty where nothing is known.
  virtual std::vector<vtkSmartPointer<vtkPolyData>> GetTriangles() = 0;
  /// The error of an export: why what is shown has no triangles, and what to do. Empty where it has.
  virtual std::string GetExportObstacle() const { return {}; }
};

#endif
