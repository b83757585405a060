// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMBlockLooks_h
#define vtkDSMBlockLooks_h

#include <array>
#include <map>
#include <optional>

/// Appearance that was set for a block of a dataset of images; a plain value, for messages between
/// ranks.
struct vtkDSMBlockLook
{
  std::optional<std::array<double, 3>> Color; ///< in place of the color array as well
  std::optional<double> Opacity;
  std::optional<double> Value; ///< value by which the lookup table colors the block
  bool IsHidden = false;

  bool operator==(const vtkDSMBlockLook& other) const
  {
    return this->Color == other.Color && this->Opacity == other.Opacity &&
      this->Value == other.Value && this->IsHidden == other.IsHidden;
  }
};

/// By the block's number in this rank's dataset, as vtkCompositeDataIterator counts; 0 is a dataset that is one
/// image, and the colors and the opacity of AMR.
using vtkDSMBlockLooks = std::map<unsigned int, vtkDSMBlockLook>;

#endif
