// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/field/levels/LevelSections.h"

#include "DSMRayTracing/field/levels/LevelField.h"

#include <glm/geometric.hpp>

namespace rt
{

bool LevelSections::FindNext(const Ray& ray, const Line&, Hit& hit) const
{
  const Hit last = hit;
  const auto& bounds = this->Field.Voxels->Lattice.GetBounds();
  bool found = false;
  for (std::size_t number = 0; number < this->Planes.size(); ++number)
  {
    const SectionPlane& plane = this->Planes[number];
    const double t =
      glm::dot(plane.Normal, plane.Point - ray.Origin) / glm::dot(plane.Normal, ray.Direction);
    const auto index = static_cast<int>(number);
    const bool isBehind = last.Plane < 0 || t > last.T || (t == last.T && index > last.Plane);
    // Not where the ray lies in the plane, and T is not a number.
    if (!(t >= ray.Min && t <= ray.Max) || !isBehind || (found && t >= hit.T))
    {
      continue;
    }
    const glm::dvec3 point = this->Field.ToIndex(ray.Origin + t * ray.Direction);
    const glm::dvec3 inside = glm::clamp(point, bounds[0], bounds[1]);
    // A plane on the border of the cells is there.
    const glm::dvec3 slack = 1e-9 * (bounds[1] - bounds[0]);
    if (glm::all(glm::lessThanEqual(glm::abs(point - inside), slack)))
    {
      hit = { t, index, { inside, glm::ivec3(0), bricks::LevelLattice::None } };
      found = true;
    }
  }
  return found;
}

} // namespace rt
