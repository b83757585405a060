// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_TriangleRay_h
#define rt_TriangleRay_h

#include <utility>

namespace rt
{

/// A ray as triangles are tested against it, after Woop et al. 2013; in the space of the mesh,
/// relative to the mesh's origin.
struct TriangleRay
{
  /// Axes[2] is the one along which the ray moves most; the others are such that the winding of
  /// triangles is kept.
  int Axes[3];
  double Origin[3]; ///< along Axes
  double Shear[3];
  double Min;
  double Max;

  /// `backward`: the ray moves towards smaller coordinates along `largest`.
  void SetAxes(int largest, bool backward)
  {
    this->Axes[0] = (largest + 1) % 3;
    this->Axes[1] = (largest + 2) % 3;
    this->Axes[2] = largest;
    if (backward)
    {
      std::swap(this->Axes[0], this->Axes[1]);
    }
  }
};

} // namespace rt

#endif
