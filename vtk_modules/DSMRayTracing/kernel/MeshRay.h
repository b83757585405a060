// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshRay_h
#define rt_MeshRay_h

#include "DSMRayTracing/kernel/BoxRay.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rt
{

/// A ray in the space of a mesh, relative to the mesh's origin, with what the tests of boxes and
/// triangles need. T is that of the world ray.
struct MeshRay
{
  double Origin[3];
  double Direction[3];
  double Min;
  double Max;
  /// Axes after Woop et al. 2013: Axes[2] is the one along which the ray moves most; the others are
  /// such that the winding of triangles is kept.
  int Axes[3];
  double Shear[3];
  /// Equal for rays that move in the same direction on each axis, and most along the same one.
  unsigned Heading;
  /// Shear along the axes that follow Axes[2] in turn, not exchanged.
  float FilterShear[2];

  BoxRay Boxes;
  /// In units of Boxes: where the ray, or what is left of it, ends.
  float BoxesEnd;
  /// Boxes start at T = StartT, and their unit is 1 / BoxesPerT.
  double StartT;
  double BoxesPerT;
  /// See TriangleFilter. Float coordinates relative to the start are off by no more than this.
  float Uncertainty;

  /// Lower and upper corner of the mesh, relative to its origin. False when the ray cannot hit
  /// anything: it misses the bounds, has no direction, or is not finite.
  bool Set(const double origin[3], const double direction[3], double first, double last,
    const double lower[3], const double upper[3])
  {
    double longest = 0.0;
    double extent = 0.0;
    double distance = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Origin[axis] = origin[axis];
      this->Direction[axis] = direction[axis];
      longest = std::max(longest, std::abs(direction[axis]));
      extent = std::max(extent, upper[axis] - lower[axis]);
      distance = std::max(distance, std::abs(origin[axis]) + std::abs(lower[axis]));
    }
    if (!(longest > 0.0) || !std::isfinite(longest + distance))
    {
      return false;
    }
    // Moving the planes by this much makes up for rounding here and in the single precision tests.
    const double margin = extent * 0x1p-20 + distance * 0x1p-46 + SmallestMargin;
    this->Min = first;
    this->Max = last;
    double enter = first;
    double leave = last;
    double inverse[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const double low = lower[axis] - margin - origin[axis];
      const double high = upper[axis] + margin - origin[axis];
      inverse[axis] = 1.0 / direction[axis];
      if (std::abs(direction[axis]) <= longest * SmallestSlope)
      {
        if (low > 0.0 || high < 0.0)
        {
          return false;
        }
        continue;
      }
      enter = std::max(enter, std::min(low * inverse[axis], high * inverse[axis]));
      leave = std::min(leave, std::max(low * inverse[axis], high * inverse[axis]));
    }
    if (!(enter <= leave))
    {
      return false;
    }
    this->Uncertainty = static_cast<float>(margin);
    this->SetShear(inverse);
    this->SetBoxes(enter, leave, longest, inverse, margin);
    return true;
  }

  /// What lies behind `t` need not be visited any more.
  void Shorten(double t)
  {
    this->Max = t;
    this->BoxesEnd = this->GetBoxesT(t);
  }

private:
  static constexpr double SmallestSlope = 1e-15;
  /// Keeps the reciprocals of differences of coordinates finite.
  static constexpr double SmallestMargin = 1e-25;

  float GetBoxesT(double t) const
  {
    const double place = (t - this->StartT) * this->BoxesPerT;
    return static_cast<float>(place + std::abs(place) * 0x1p-20 + this->Uncertainty);
  }

  void SetShear(const double inverse[3])
  {
    int largest = 0;
    for (int axis = 1; axis < 3; ++axis)
    {
      largest =
        std::abs(this->Direction[axis]) > std::abs(this->Direction[largest]) ? axis : largest;
    }
    this->Axes[0] = (largest + 1) % 3;
    this->Axes[1] = (largest + 2) % 3;
    this->Axes[2] = largest;
    const double scale = inverse[largest];
    this->FilterShear[0] = static_cast<float>(this->Direction[this->Axes[0]] * scale);
    this->FilterShear[1] = static_cast<float>(this->Direction[this->Axes[1]] * scale);
    if (this->Direction[largest] < 0.0)
    {
      std::swap(this->Axes[0], this->Axes[1]);
    }
    this->Shear[0] = this->Direction[this->Axes[0]] * scale;
    this->Shear[1] = this->Direction[this->Axes[1]] * scale;
    this->Shear[2] = scale;
  }

  void SetBoxes(double enter, double leave, double longest, double inverse[3], double margin)
  {
    this->StartT = enter;
    this->BoxesPerT = longest;
    double start[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      start[axis] = this->Origin[axis] + enter * this->Direction[axis];
      inverse[axis] *= longest;
    }
    this->Boxes.Set(start, inverse, margin);
    this->Heading = static_cast<unsigned>(this->Axes[2]);
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Heading |= (inverse[axis] < 0.0 ? 4u : 0u) << axis;
    }
    this->BoxesEnd = this->GetBoxesT(leave);
  }
};

} // namespace rt

#endif
