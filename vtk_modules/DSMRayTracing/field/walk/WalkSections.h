// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_WalkSections_h
#define rt_WalkSections_h

#include "DSMRayTracing/field/PlaneSections.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace rt
{

/// The sections of planes through a field: where rays meet them within its bounds, by FieldType::FindPlace. See
/// LatticeSections. Reads no bricks. Any number of threads may ask.
template <class FieldType>
class WalkSections
{
public:
  struct Line
  {
  };
  using Hit = SectionHit<typename FieldType::Place>;

  /// Keeps both by reference.
  WalkSections(const FieldType& field, const std::vector<SectionPlane>& planes)
    : Field(field)
    , Planes(planes)
  {
  }

  /// The planes need no more than the ray itself.
  bool GetLine(const Ray&, Line&) const { return true; }

  bool FindNext(const Ray& ray, const Line&, Hit& hit) const
  {
    const double lastT = hit.T;
    const int lastPlane = hit.Plane;
    bool found = false;
    for (std::size_t number = 0; number < this->Planes.size(); ++number)
    {
      const SectionPlane& plane = this->Planes[number];
      const double t =
        glm::dot(plane.Normal, plane.Point - ray.Origin) / glm::dot(plane.Normal, ray.Direction);
      const auto index = static_cast<int>(number);
      const bool isBehind = lastPlane < 0 || t > lastT || (t == lastT && index > lastPlane);
      // Not where the ray lies in the plane, and T is not a number.
      if (t >= ray.Min && t <= ray.Max && isBehind && !(found && t >= hit.T))
      {
        typename FieldType::Place place;
        if (this->Field.FindPlace(ray.Origin + t * ray.Direction, place))
        {
          hit = { t, index, place };
          found = true;
        }
      }
    }
    return found;
  }

  /// Which bricks the planes pass through is not foreseen.
  SectionBeam FindBeam(const Ray[4]) const
  {
    SectionBeam beam;
    beam.Usable = true;
    return beam;
  }

protected:
  const FieldType& Field;
  const std::vector<SectionPlane>& Planes;
};

} // namespace rt

#endif
