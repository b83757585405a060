// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMBlockLooks_h
#define vtkDSMBlockLooks_h

#include <array>
#include <cstdint>
#include <map>

/// What was set for a block of a dataset of images; a plain value, that travels between ranks.
struct vtkDSMBlockLook
{
  /// Negative: not set. In place of the colour array as well.
  std::array<double, 3> Color{ -1.0, -1.0, -1.0 };
  /// Negative: not set.
  double Opacity = -1.0;
  /// What the lookup table colours the block by, if any.
  double Value = 0.0;
  std::int64_t HasValue = 0;

  bool HasColor() const { return this->Color[0] >= 0.0; }
  bool HasOpacity() const { return this->Opacity >= 0.0; }

  bool operator==(const vtkDSMBlockLook& other) const
  {
    return this->Color == other.Color && this->Opacity == other.Opacity &&
      this->Value == other.Value && this->HasValue == other.HasValue;
  }
};

/// By the block's number in this rank's dataset, as vtkCompositeDataIterator counts; 0 is a dataset that is one image.
using vtkDSMBlockLooks = std::map<unsigned int, vtkDSMBlockLook>;

#endif
