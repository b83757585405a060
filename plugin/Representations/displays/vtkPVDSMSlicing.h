// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMSlicing_h
#define vtkPVDSMSlicing_h

#include <array>
#include <vector>

class vtkDSMVolumeMapper;

/// The slices of a display.
class vtkPVDSMSlicing
{
public:
  struct Axis
  {
    bool IsShown = true;
    /// Index of the slice among the samples along the axis, from 0; negative: the middle one.
    int Index = -1;
    std::vector<int> Further; ///< further indices, shown in any case
  };
  std::array<Axis, 3> Axes;
  bool HasPlane = false;
  std::array<double, 3> Origin{ 0.0, 0.0, 0.0 }; ///< point of the plane, world
  std::array<double, 3> Normal{ 1.0, 0.0, 0.0 };

  /// Gives the mapper its slices.
  void ApplyTo(vtkDSMVolumeMapper* mapper) const;
};

#endif
