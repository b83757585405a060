// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfaceSearch_h
#define rt_IsosurfaceSearch_h

#include "DSMRayTracing/ray/CellHit.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"
#include "DSMRayTracing/volume/BrickAccess.h"
#include "DSMRayTracing/volume/BrickWalk.h"
#include "DSMRayTracing/volume/GridRay.h"
#include "DSMRayTracing/volume/HitGradient.h"
#include "DSMRayTracing/volume/IsosurfaceHit.h"
#include "DSMRayTracing/volume/IsosurfaceObject.h"
#include "DSMRayTracing/volume/IsovaluePredicate.h"

#include <glm/vec3.hpp>

#include <vector>

namespace rt
{

/// Finds isosurface hits through a store (ObjectStore now; others have the same members): walks the
/// coarse macrocells front to back, acquires each brick that may hold a surface once a visit, and
/// searches it (GridTraversal). Pure: the result depends on the ray and the data only. One for each
/// worker: it holds at most one pin, and none while it acquires or when a call returns. `Access`: see
/// BrickAccess.
template <class Store, template <class> class Access = BrickAccess>
class IsosurfaceSearch
{
public:
  IsosurfaceSearch(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
  {
  }

  /// The first hit in [ray.Min, ray.Max], normal included. May wait for bricks. Of several
  /// isovalues the nearest hit counts, of equally near ones the lowest isovalue.
  bool Intersect(const IsosurfaceObject& object, const Ray& ray, IsosurfaceHit& hit) const;

  /// The same for each ray of a batch that is `wanted`. Returns those that hit something, and calls
  /// `open(index, t)` for each of them, which says where the hit is to be stored, or null: nowhere.
  template <class Open>
  RayMask IntersectEach(
    const IsosurfaceObject& object, const Ray* rays, RayMask wanted, const Open& open) const
  {
    return FindRays(wanted,
      [&](int index)
      {
        IsosurfaceHit hit;
        const bool found = this->Intersect(object, rays[index], hit);
        if (found)
        {
          if (IsosurfaceHit* const place = open(index, hit.T))
          {
            *place = hit;
          }
        }
        return found;
      });
  }

  /// Whether there is any hit in [ray.Min, ray.Max]: whether Intersect finds one. May wait for
  /// bricks.
  bool IsOccluded(const IsosurfaceObject& object, const Ray& ray) const;

  /// Multiplies `transmittance` by those of all surfaces in [ray.Min, ray.Max]: `sheets` has one for each isovalue.
  /// Returns whether the ray is dark (IsDark) then; the search ends early when it is. May wait for bricks.
  bool Attenuate(const IsosurfaceObject& object, const std::vector<glm::dvec3>& sheets,
    const Ray& ray, glm::dvec3& transmittance) const;

private:
  using Walk = BrickWalk<IsovaluePredicate>;

  template <class T>
  bool IntersectBricks(const IsosurfaceObject& object, const GridRay& line, double enter,
    double leave, IsosurfaceHit& hit, double gradient[3]) const;

  /// Searches the brick of the walk for all isovalues of its range; `hasGradient` tells that the
  /// gradient was found too, as it is when its samples are all in the brick.
  template <class T>
  bool IntersectBrick(const IsosurfaceObject& object, const GridRay& line, const Walk& walk,
    CellHit& cell, int& isovalue, double gradient[3], bool& hasGradient) const;

  /// Calls `isDone(sample, traversal, range, walk)` for the bricks on the ray, front to back, until it says so, and returns
  /// whether it did. `sample` has the type of the samples; `range` is that of the brick's values.
  template <class IsDone>
  bool SearchBricks(const IsosurfaceObject& object, const Ray& ray, const IsDone& isDone) const;

  Store& Blocks;
  typename Store::Worker& Self;
};

} // namespace rt

#include "DSMRayTracing/volume/IsosurfaceSearch.txx"

#endif
