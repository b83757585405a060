// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FieldSegment_h
#define rt_FieldSegment_h

#include "DSMBricks/base/ValueRange.h"
#include "DSMRayTracing/field/Cubic.h"

namespace rt
{

/// A part of a ray along which the values of a field are a cubic, such as the way through a cell.
template <class PlaceType>
struct FieldSegment
{
  double Enter; ///< T
  double Exit;  ///< T
  Cubic Values; ///< from Enter, at 0, to Exit, at 1
  /// The value at Exit: the same bits as at Enter of a segment that begins there.
  double Last;
  /// Holds all values of the segment.
  bricks::ValueRange Range;
  PlaceType At; ///< any place of the segment

  /// T at a part of the way, from 0 to 1.
  double GetT(double part) const
  {
    const double t = this->Enter + part * (this->Exit - this->Enter);
    return t < this->Exit ? t : this->Exit;
  }
};

} // namespace rt

#endif
