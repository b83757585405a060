// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMClipping_h
#define vtkPVDSMClipping_h

#include "vtkSmartPointer.h"

#include <array>

class vtkAbstractMapper;
class vtkBoundingBox;
class vtkMatrix4x4;
class vtkPolyData;

/// Visible region of a representation's dataset: the side of a plane, the inside of a box.
class vtkPVDSMClipping
{
public:
  bool Clips = false;
  std::array<double, 3> Origin{ 0.0, 0.0, 0.0 }; ///< point of the plane, world
  std::array<double, 3> Normal{ 1.0, 0.0, 0.0 }; ///< to the side that is shown
  bool Crops = false;
  /// x, y and z from, to; in the dataset's coordinates. ParaView's interactive box moves, turns (degrees
  /// about z, x, y) and scales it; or the unit box, when UsesBox is off.
  std::array<double, 6> Box{ 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  bool UsesBox = true;
  std::array<double, 3> BoxPosition{ 0.0, 0.0, 0.0 };
  std::array<double, 3> BoxRotation{ 0.0, 0.0, 0.0 };
  std::array<double, 3> BoxScale{ 1.0, 1.0, 1.0 };

  /// Gives the mapper its clipping planes, `dataToWorld` being where the dataset is.
  void ApplyTo(vtkAbstractMapper* mapper, vtkMatrix4x4* dataToWorld) const;

  /// Returns what hides all of a box in the world ("clipping plane" or "cropping box"), if one of the mapper's
  /// clipping planes does; else null.
  const char* FindWhatHides(vtkAbstractMapper* mapper, const vtkBoundingBox& box) const;

  /// Returns the visible part of polygons in the dataset's coordinates.
  vtkSmartPointer<vtkPolyData> Clip(vtkPolyData* polygons, vtkMatrix4x4* dataToWorld) const;
};

#endif
