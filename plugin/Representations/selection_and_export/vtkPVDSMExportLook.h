// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMExportLook_h
#define vtkPVDSMExportLook_h

#include "vtkSmartPointer.h"

#include <array>
#include <map>
#include <optional>
#include <vector>

class vtkActor;
class vtkAppendPolyData;
class vtkPolyData;

/// How blocks of what is exported look that are not to look like the rest. It travels from server to client in the
/// field data of the blocks' polygons.
struct vtkPVDSMExportLook
{
  std::optional<std::array<double, 3>> Color; ///< in place of the color array as well
  std::optional<double> Opacity;

  bool operator<(const vtkPVDSMExportLook& other) const
  {
    return this->Color != other.Color ? this->Color < other.Color : this->Opacity < other.Opacity;
  }

  /// Returns the look that GiveTo stored in the polygons; an empty one if there is none.
  static vtkPVDSMExportLook Get(vtkPolyData* polygons);
  void GiveTo(vtkPolyData* polygons) const;
  /// To an actor that has the look of the rest.
  void ApplyTo(vtkActor* actor) const;
};

/// Puts together polygons that look alike.
class vtkPVDSMExportParts
{
public:
  void Add(vtkPolyData* polygons, const vtkPVDSMExportLook& look);
  /// One for each look, which it has been given; without those that have no polygons.
  std::vector<vtkSmartPointer<vtkPolyData>> Finish() const;

private:
  std::map<vtkPVDSMExportLook, vtkSmartPointer<vtkAppendPolyData>> Parts;
};

#endif
