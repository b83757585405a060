// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_ValueRange_h
#define bricks_ValueRange_h

#include <algorithm>
#include <limits>

namespace bricks
{

/// Smallest and largest value of a part of a field, as of the cells of a macrocell, rounded outward to float; empty
/// (First > Last) when no cell holds data.
struct ValueRange
{
  float First;
  float Last;

  /// The range of no values.
  static constexpr ValueRange GetEmpty()
  {
    return { std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity() };
  }

  /// Grows to hold the other range, too; bounds of it that are not a number count for nothing.
  void Add(const ValueRange& other)
  {
    this->First = std::min(this->First, other.First);
    this->Last = std::max(this->Last, other.Last);
  }

  /// Returns whether a surface of this isovalue may pass. A value equal to the isovalue is inside
  /// of the surface, so First must be below it; this skips the flat background of an integer
  /// volume.
  bool MayHold(double isovalue) const
  {
    return static_cast<double>(this->First) < isovalue &&
      isovalue <= static_cast<double>(this->Last);
  }
};

} // namespace bricks

#endif
