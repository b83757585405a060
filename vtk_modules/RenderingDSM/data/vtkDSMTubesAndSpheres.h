// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMTubesAndSpheres_h
#define vtkDSMTubesAndSpheres_h

#include <string>

class vtkDataArray;
class vtkPolyData;

/// How thick the lines and the vertices of a vtkPolyData are shown, as tubes and spheres: what has no
/// extent of its own cannot be hit by a ray.
struct vtkDSMTubesAndSpheres
{
  /// In the units of the points. Not positive: none are shown.
  double LineRadius = 0.0;
  double PointRadius = 0.0;
  /// Name of a point array that the radii are multiplied by, or empty.
  std::string RadiusArray;

  bool HasTubes(vtkPolyData* data) const;
  bool HasSpheres(vtkPolyData* data) const;
  bool HasAny(vtkPolyData* data) const { return this->HasTubes(data) || this->HasSpheres(data); }

  /// Null without an array. Throws dsm::Error when it cannot be used.
  vtkDataArray* FindFactors(vtkPolyData* data) const;
};

#endif
