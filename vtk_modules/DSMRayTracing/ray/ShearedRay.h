// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_ShearedRay_h
#define rt_ShearedRay_h

#include "DSMRayTracing/ray/BoxRay.h"
#include "DSMRayTracing/ray/TriangleRay.h"

#include <algorithm>
#include <cmath>

namespace rt
{

/// A ray in the space of bricks of triangles or cells, relative to its origin, with what the tests of boxes and
/// triangles need. T is that of the world ray.
struct ShearedRay
{
  TriangleRay Triangles;
  /// Shear along the axes that follow Triangles.Axes[2] in turn, not exchanged.
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
      longest = std::max(longest, std::abs(direction[axis]));
      extent = std::max(extent, upper[axis] - lower[axis]);
      distance = std::max(distance, std::abs(origin[axis]) + std::abs(lower[axis]));
    }
    if (!(longest > 0.0) || !std::isfinite(longest + distance))
    {
      return false;
    }
    // Moving the planes by this much makes up for rounding here and in the single precision tests.
    const double margin = extent * ExtentPart + distance * DistancePart + SmallestMargin;
    this->Triangles.Min = first;
    this->Triangles.Max = last;
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
    this->SetShear(origin, direction, inverse);
    this->SetBoxes(origin, direction, enter, leave, longest, inverse, margin);
    return true;
  }

  /// Ends the ray at `t`: boxes behind it need not be visited.
  void Shorten(double t)
  {
    this->Triangles.Max = t;
    this->BoxesEnd = GetBoxesT(t, this->StartT, this->BoxesPerT, this->Uncertainty);
  }

  /// Nothing need be visited any more.
  void End() { this->BoxesEnd = NoBoxes; }

  /// An end before the start of all boxes.
  static constexpr float NoBoxes = -1.0f;

  /// A T in units of boxes, rounded up.
  static float GetBoxesT(double t, double startT, double boxesPerT, float uncertainty)
  {
    const double place = (t - startT) * boxesPerT;
    return static_cast<float>(place + std::abs(place) * PlacePart + uncertainty);
  }

  /// A ray that moves less than this part of its way along an axis is parallel to its planes.
  static constexpr double SmallestSlope = 1e-15;
  /// Bounds of the rounding error, relative to the extent of the mesh, its distance, and a place on
  /// the ray.
  static constexpr double ExtentPart = 0x1p-20;
  static constexpr double DistancePart = 0x1p-46;
  static constexpr double PlacePart = 0x1p-20;
  /// Keeps the reciprocals of differences of coordinates finite.
  static constexpr double SmallestMargin = 1e-25;

private:
  void SetShear(const double origin[3], const double direction[3], const double inverse[3])
  {
    int largest = 0;
    for (int axis = 1; axis < 3; ++axis)
    {
      largest = std::abs(direction[axis]) > std::abs(direction[largest]) ? axis : largest;
    }
    this->Triangles.SetAxes(largest, direction[largest] < 0.0);
    const double scale = inverse[largest];
    this->FilterShear[0] = static_cast<float>(direction[(largest + 1) % 3] * scale);
    this->FilterShear[1] = static_cast<float>(direction[(largest + 2) % 3] * scale);
    for (int place = 0; place < 3; ++place)
    {
      this->Triangles.Origin[place] = origin[this->Triangles.Axes[place]];
    }
    this->Triangles.Shear[0] = direction[this->Triangles.Axes[0]] * scale;
    this->Triangles.Shear[1] = direction[this->Triangles.Axes[1]] * scale;
    this->Triangles.Shear[2] = scale;
  }

  void SetBoxes(const double origin[3], const double direction[3], double enter, double leave,
    double longest, double inverse[3], double margin)
  {
    this->StartT = enter;
    this->BoxesPerT = longest;
    double start[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      start[axis] = origin[axis] + enter * direction[axis];
      inverse[axis] *= longest;
    }
    this->Boxes.Set(start, inverse, margin);
    this->BoxesEnd = GetBoxesT(leave, enter, longest, this->Uncertainty);
  }
};

} // namespace rt

#endif
