// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/frame/SampleWidth.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
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

/// Of places at w = 1.
double FindWidth(
  const FrameRequest& request, const glm::dmat4& indexToClip, const glm::dvec3& steps)
{
  double width = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    // Within the picture, x / w and y / w are from -1 to 1.
    const glm::dvec4 step = steps[axis] * glm::abs(indexToClip[axis]);
    width = std::max(width,
      0.5 * std::hypot(request.Width * (step.x + step.w), request.Height * (step.y + step.w)));
  }
  return width;
}

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
  const double width = FindWidth(request, indexToClip, glm::dvec3(1.0));
  return w > 0.0 ? width / w : std::numeric_limits<double>::infinity();
}

SeenPart::SeenPart(
  const FrameRequest& request, const glm::dmat4& indexToWorld, const glm::dvec3& last)
  : Request(request)
  , IndexToClip(request.WorldToClip * indexToWorld)
  , Last(last)
{
}

double SeenPart::GetWidth(const glm::dvec3& step) const
{
  return FindWidth(this->Request, this->IndexToClip, step);
}

std::optional<SeenPart::Bounds> SeenPart::Find(double depth) const
{
  // In parts of the lattice's size, as the points p with dot(plane, (p, 1)) >= 0.
  const glm::dvec3 size = glm::max(this->Last, glm::dvec3(1.0));
  const auto scale = [&](const glm::dvec4& plane)
  {
    const glm::dvec4 scaled(glm::dvec3(plane) * size, plane.w);
    const double length = glm::length(glm::dvec3(scaled));
    return length > 0.0 ? scaled / length : scaled;
  };
  const glm::dmat4 rows = glm::transpose(this->IndexToClip);
  std::vector<glm::dvec4> planes;
  for (int axis = 0; axis < 3; ++axis)
  {
    glm::dvec4 lower(0.0);
    lower[axis] = 1.0;
    planes.push_back(lower);
    planes.push_back(glm::dvec4(-glm::dvec3(lower), this->Last[axis] / size[axis]));
    planes.push_back(scale(rows[3] + rows[axis]));
    planes.push_back(scale(rows[3] - rows[axis]));
  }
  if (std::isfinite(depth))
  {
    planes.push_back(scale(glm::dvec4(0.0, 0.0, 0.0, depth) - rows[3]));
  }
  // Every corner of the body is where three of the planes meet.
  std::optional<Bounds> bounds;
  const auto add = [&](const glm::dvec3& corner)
  {
    const glm::dvec3 place = corner * size;
    const double w = glm::dot(rows[3], glm::dvec4(place, 1.0));
    bounds = bounds ? Bounds{ glm::min(bounds->Lower, place), glm::max(bounds->Upper, place),
      std::min(bounds->Nearest, w), std::max(bounds->Farthest, w) }
                    : Bounds{ place, place, w, w };
  };
  constexpr double slack = 1e-9;
  for (std::size_t first = 0; first < planes.size(); ++first)
  {
    for (std::size_t second = first + 1; second < planes.size(); ++second)
    {
      for (std::size_t third = second + 1; third < planes.size(); ++third)
      {
        const glm::dvec3 a(planes[first]);
        const glm::dvec3 b(planes[second]);
        const glm::dvec3 c(planes[third]);
        const double volume = glm::dot(a, glm::cross(b, c));
        if (std::abs(volume) < 1e-12)
        {
          continue;
        }
        const glm::dvec3 corner =
          -(planes[first].w * glm::cross(b, c) + planes[second].w * glm::cross(c, a) +
            planes[third].w * glm::cross(a, b)) /
          volume;
        if (std::all_of(planes.begin(), planes.end(),
              [&](const glm::dvec4& plane)
              { return glm::dot(plane, glm::dvec4(corner, 1.0)) >= -slack; }))
        {
          add(corner);
        }
      }
    }
  }
  return bounds;
}

} // namespace rt
