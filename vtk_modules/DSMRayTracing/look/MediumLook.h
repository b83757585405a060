// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MediumLook_h
#define rt_MediumLook_h

#include "DSMRayTracing/look/Material.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace rt
{

/// A factor of extinction for each length of a gradient.
struct GradientOpacity
{
  /// Values grow so much in a cell of mean size at the last of the factors; at the first, they do not grow.
  double Last = 1.0;
  std::vector<double> Factors; ///< at least 2, evenly spaced

  /// The nearest one.
  double GetFactor(double growth) const
  {
    const double place = growth / this->Last * static_cast<double>(this->Factors.size() - 1);
    return this->Factors[std::min(
      static_cast<std::size_t>(std::max(place, 0.0) + 0.5), this->Factors.size() - 1)];
  }
};

/// How a medium looks, besides its color and extinction.
struct MediumLook
{
  /// True: lights shade the medium like a surface across the gradient. False: the medium emits
  /// light by itself.
  bool Shade = false;
  /// How they do, in the medium's own colors.
  Material Surface;
  /// The part of the look that is light scattered once towards the viewer, in [0, 1]; the rest is the surface's.
  double Scattering = 0.0;
  /// The mean cosine of the angle by which scattered light turns, in (-1, 1): g of Henyey and Greenstein.
  double Anisotropy = 0.0;
  /// Null: extinction does not depend on the gradient.
  std::shared_ptr<const GradientOpacity> Gradients;
  /// True: the value of a place is that of the nearest sample, so that samples are boxes. False: values are
  /// interpolated.
  bool Nearest = false;
  /// True: errors are a small part of what a pixel of 8 bits can show. False: they are too small to be seen.
  bool Exact = false;

  bool IsLit() const { return this->Shade || this->Scattering > 0.0; }
};

} // namespace rt

#endif
