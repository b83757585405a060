// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumTolerance_h
#define rt_MediumTolerance_h

namespace rt
{

/// How finely a way through a medium is cut into pieces, in each of which values are taken for linear. Errors count as
/// far as the pixel sees them: by the transmittance before the way.
struct MediumTolerance
{
  /// Error of the optical depth of a way.
  static constexpr double Depth = 1.0 / 2048.0;
  /// Bound of the error of the optical depth of a way through several cells in one step, in which values are taken for
  /// quadratic. The bound is that of the worst ray through the worst of the cells: what pixels are off by is a
  /// hundredth of it.
  static constexpr double Joint = 1.0 / 32.0;
  /// Error of the light of a way that is shaded at one place.
  static constexpr double Glare = 1.0 / 256.0;
  /// The same in a cell, which is cut into halves where it is larger, as if it were that of the macrocell.
  static constexpr double CellGlare = 1.0 / 16.0;
  /// Error of the color of a piece: the front of a piece hides part of its back.
  static constexpr double Color = 1.0 / 1024.0;
  /// Pieces that are described for a unit of optical depth.
  static constexpr double DescribedPieces = 4.0;
  /// How much less errors are where all that counts is to be exact, and how much larger they may be of the light that
  /// gets to a place.
  static constexpr double Exact = 64.0;
  static constexpr double Shadow = 8.0;
  /// In bins of the function: on a shorter way, it is nearly constant, and differences would be rounding.
  static constexpr double ShortWay = 1e-7;
};

} // namespace rt

#endif
