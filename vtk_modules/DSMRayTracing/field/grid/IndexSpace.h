// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IndexSpace_h
#define rt_IndexSpace_h

#include "DSMBricks/layout/GridPlanes.h"
#include "DSMRayTracing/field/grid/GridRay.h"
#include "DSMRayTracing/field/grid/StretchedRay.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace rt
{

/// The affine map from world space to the index space of an object, or to the grid space of a rectilinear one.
class IndexSpace
{
public:
  /// `indexToWorld` and its inverse. `planes`: of a rectilinear grid, kept by reference, or null.
  IndexSpace(const glm::dmat4& indexToWorld, const glm::dmat4& worldToIndex,
    const bricks::GridPlanes* planes = nullptr)
    : WorldOrigin(indexToWorld[3])
    , WorldToIndex(worldToIndex)
    , Planes(planes)
  {
  }

  /// Null: planes between cells are at whole numbers.
  const bricks::GridPlanes* GetPlanes() const { return this->Planes; }

  /// Returns the origin of the index space in world space.
  const glm::dvec3& GetOrigin() const { return this->WorldOrigin; }
  /// Takes differences of world points to index space.
  const glm::dmat3& GetWorldToIndex() const { return this->WorldToIndex; }

  /// The same T in both spaces. False when the ray cannot be traced (no direction, not finite).
  bool GetGridRay(const Ray& ray, GridRay& line) const
  {
    // Subtracting first keeps the digits of a small volume far from the world's origin.
    const glm::dvec3 origin = this->WorldToIndex * (ray.Origin - this->WorldOrigin);
    const glm::dvec3 direction = this->WorldToIndex * ray.Direction;
    return line.Set(&origin.x, &direction.x);
  }

  /// Calls `visit` with the ray as it meets the planes: a GridRay or StretchedRay. Returns what `visit` does; false
  /// for a ray that cannot be traced.
  template <class Visit>
  bool VisitLine(const Ray& ray, const Visit& visit) const
  {
    if (this->Planes)
    {
      StretchedRay line(*this->Planes);
      return this->GetGridRay(ray, line) && visit(line);
    }
    GridRay line;
    return this->GetGridRay(ray, line) && visit(line);
  }

  /// The unit normal of a surface in world space, in which the scalar falls, out of the scalar's
  /// gradient in index space. Where there is no gradient: towards the viewer.
  glm::dvec3 GetNormal(const double gradient[3], const glm::dvec3& rayDirection) const;

private:
  glm::dvec3 WorldOrigin; ///< origin of the index space
  glm::dmat3 WorldToIndex;
  const bricks::GridPlanes* Planes;
};

} // namespace rt

#endif
