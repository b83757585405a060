// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_BoundingBox_h
#define bricks_BoundingBox_h

#include "DSMBricks/base/Float4.h"

#include <limits>

namespace bricks
{

/// An axis-aligned box in floats; empty until something is added. The fourth lanes mean nothing.
struct BoundingBox
{
  Float4 Lower = Float4::Fill(std::numeric_limits<float>::infinity());
  Float4 Upper = Float4::Fill(-std::numeric_limits<float>::infinity());

  void Add(Float4 point)
  {
    this->Lower = Min(this->Lower, point);
    this->Upper = Max(this->Upper, point);
  }
  void Add(const BoundingBox& other)
  {
    this->Lower = Min(this->Lower, other.Lower);
    this->Upper = Max(this->Upper, other.Upper);
  }
  /// Half of its surface; not for an empty box.
  float GetArea() const
  {
    float size[4];
    (this->Upper - this->Lower).Store(size);
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

} // namespace bricks

#endif
