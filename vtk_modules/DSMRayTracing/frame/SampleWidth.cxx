// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/SampleWidth.h"

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rt
{

namespace
{

/// A box of index space that is divided where the picture shows it.
class SeenBox
{
public:
  explicit SeenBox(const glm::dmat4& indexToClip)
    : IndexToClip(indexToClip)
  {
  }

  /// Looks for a place in a box that the picture shows, and that has a smaller w than those before.
  void Search(const glm::dvec3& low, const glm::dvec3& high, int divisions = 5)
  {
    glm::dvec4 corners[8];
    double least = std::numeric_limits<double>::infinity();
    bool areAllSeen = true;
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::dvec3 place((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
        (corner & 4) != 0 ? high.z : low.z);
      corners[corner] = this->IndexToClip * glm::dvec4(place, 1.0);
      least = std::min(least, corners[corner].w);
      areAllSeen = areAllSeen && IsSeen(corners[corner]);
    }
    if (least >= this->Least || IsBeside(corners))
    {
      return;
    }
    if (areAllSeen || divisions == 0)
    {
      this->Least = least;
      return;
    }
    const glm::dvec3 half = 0.5 * (low + high);
    for (int part = 0; part < 8; ++part)
    {
      const glm::dvec3 upper((part & 1) != 0, (part & 2) != 0, (part & 4) != 0);
      this->Search(glm::mix(low, half, upper), glm::mix(half, high, upper), divisions - 1);
    }
  }

  /// The smallest w in clip space, to which widths are inverse, of the places that were found; infinite without any.
  double GetLeastW() const { return this->Least; }

private:
  static bool IsSeen(const glm::dvec4& place)
  {
    return std::max({ std::abs(place.x), std::abs(place.y), std::abs(place.z) }) <= place.w;
  }

  /// Returns whether all of the corners are on the outer side of one of the picture's borders.
  static bool IsBeside(const glm::dvec4 corners[8])
  {
    for (int side = 0; side < 6; ++side)
    {
      const double sign = side % 2 == 0 ? 1.0 : -1.0;
      if (std::all_of(corners, corners + 8,
            [=](const glm::dvec4& corner) { return sign * corner[side / 2] > corner.w; }))
      {
        return true;
      }
    }
    return false;
  }

  glm::dmat4 IndexToClip;
  double Least = std::numeric_limits<double>::infinity();
};

} // namespace

double GetSampleWidth(
  const FrameRequest& request, const glm::dmat4& indexToWorld, const glm::dvec3& last)
{
  const glm::dmat4 indexToClip = request.WorldToClip * indexToWorld;
  SeenBox seen(indexToClip);
  seen.Search(glm::dvec3(0.0), last);
  const double w = seen.GetLeastW();
  if (std::isinf(w))
  {
    return 0.0;
  }
  double width = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    // Within the picture, x / w and y / w are from -1 to 1.
    const glm::dvec4 step = glm::abs(indexToClip[axis]);
    width = std::max(width,
      0.5 * std::hypot(request.Width * (step.x + step.w), request.Height * (step.y + step.w)));
  }
  return w > 0.0 ? width / w : std::numeric_limits<double>::infinity();
}

} // namespace rt
