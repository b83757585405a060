// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMeshBlock_h
#define vtkDSMMeshBlock_h

#include <cstdint>
#include <vector>

class vtkCompositeDataDisplayAttributes;
class vtkDataObject;
class vtkPolyData;

/// One vtkPolyData of a dataset, and how it differs from the others.
struct vtkDSMMeshBlock
{
  /// Appearance that was set for the block or for one around it; a plain value, compared as such.
  struct Look
  {
    std::int32_t Visible = 1;
    /// Negative: not set.
    float Opacity = -1.0f;
    /// Negative: not set. In place of the color array as well.
    float Color[3] = { -1.0f, -1.0f, -1.0f };

    bool operator<(const Look& other) const;
  };

  vtkPolyData* Data = nullptr;
  /// Number of the block in the dataset's tree: the same on every rank, and for all pieces of one
  /// surface.
  std::uint32_t Number = 0;
  Look Appearance;

  /// Local: this rank's, in order, those without points left out. Both may be null. Throws dsm::Error
  /// for data that are not surfaces.
  static std::vector<vtkDSMMeshBlock> Collect(
    vtkDataObject* data, vtkCompositeDataDisplayAttributes* attributes);
};

#endif
