// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMTubesAndSpheres_h
#define vtkDSMTubesAndSpheres_h

#include "vtkSmartPointer.h"

#include <cstdint>
#include <string>

class vtkPolyData;

/// Surfaces around the lines and the vertices of a vtkPolyData, with the points' and the cells'
/// arrays, and normals: what has no extent of its own cannot be hit by a ray.
class vtkDSMTubesAndSpheres
{
public:
  /// Radii in the units of the points; not positive: nothing is made. `radiusArray` names a point
  /// array that they are multiplied by, or is empty.
  vtkDSMTubesAndSpheres(double lineRadius, double pointRadius, const std::string& radiusArray);

  /// Triangles that the two methods below would make of the data, about.
  std::uint64_t EstimateTriangles(vtkPolyData* data) const;

  /// Null when there is nothing to draw. Throws dsm::Error when the radius array cannot be used.
  vtkSmartPointer<vtkPolyData> MakeTubes(vtkPolyData* data) const;
  vtkSmartPointer<vtkPolyData> MakeSpheres(vtkPolyData* data) const;

private:
  double LineRadius;
  double PointRadius;
  std::string RadiusArray;
};

#endif
