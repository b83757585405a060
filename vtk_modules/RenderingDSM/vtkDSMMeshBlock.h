// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMeshBlock_h
#define vtkDSMMeshBlock_h

#include <vector>

class vtkDSMPolyDataMapper;
class vtkPolyData;

/// One visible vtkPolyData of a mapper's input, and how it differs from the others.
struct vtkDSMMeshBlock
{
  /// What was set for the block or for one around it; a plain value, compared as such.
  struct Look
  {
    /// Negative: not set.
    float Opacity = -1.0f;
    /// Negative: not set. In place of the colour array as well.
    float Color[3] = { -1.0f, -1.0f, -1.0f };
  };

  vtkPolyData* Data = nullptr;
  Look Appearance;

  /// Local: this rank's, in order, those without points left out. Throws dsm::Error for data that
  /// are not surfaces.
  static std::vector<vtkDSMMeshBlock> Collect(vtkDSMPolyDataMapper* mapper);
};

#endif
