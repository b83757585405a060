// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IsosurfaceSearch_h
#define rt_IsosurfaceSearch_h

#include "DSMRayTracing/field/IsosurfaceHit.h"
#include "DSMRayTracing/field/LevelSets.h"
#include "DSMRayTracing/field/ValuePredicates.h"
#include "DSMRayTracing/field/grid/BrickWalk.h"
#include "DSMRayTracing/field/grid/GridRay.h"
#include "DSMRayTracing/field/grid/HitGradient.h"
#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/ray/CellHit.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/vec3.hpp>

#include <vector>

namespace rt
{

/// Finds isosurface hits through a store (ObjectStore now; others have the same members): walks the
/// coarse macrocells front to back, acquires each brick that may hold a surface once a visit, and
/// searches it (GridTraversal). Pure: the result depends on the ray and the data only. One for each
/// worker: it holds at most one pin, and none while it acquires or when a call returns.
template <class Store>
class IsosurfaceSearch
{
public:
  using Sets = LevelSets<LatticeField>;
  using Hit = LatticeHit;

  IsosurfaceSearch(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
  {
  }

  /// Finds the first hit in [ray.Min, ray.Max], with its normal. May wait for bricks. With several isovalues,
  /// the nearest hit is taken; among equally near ones, that of the lowest isovalue.
  bool Intersect(const Sets& sets, const Ray& ray, Hit& hit) const;

  /// The same for each ray of a batch that is `wanted`. Returns those that hit something, and calls
  /// `open(index, t)` for each of them, which says where the hit is to be stored, or null: nowhere.
  template <class Open>
  RayMask IntersectEach(const Sets& sets, const Ray* rays, RayMask wanted, const Open& open) const
  {
    return FindRays(wanted,
      [&](int index)
      {
        Hit hit;
        const bool found = this->Intersect(sets, rays[index], hit);
        if (found)
        {
          if (Hit* const place = open(index, hit.T))
          {
            *place = hit;
          }
        }
        return found;
      });
  }

  /// Returns whether there is any hit in [ray.Min, ray.Max], that is, whether Intersect finds one.
  /// May wait for bricks.
  bool IsOccluded(const Sets& sets, const Ray& ray) const;

  /// Multiplies `transmittance` by those of all surfaces in [ray.Min, ray.Max]: `sheets` has one for each isovalue.
  /// Returns whether the ray is dark (IsDark) then; the search ends early when it is. May wait for bricks.
  bool Attenuate(const Sets& sets, const std::vector<glm::dvec3>& sheets, const Ray& ray,
    glm::dvec3& transmittance) const;

private:
  /// `Line`: see IndexSpace::VisitLine.
  template <class Line>
  using Walk = BrickWalk<IsovaluePredicate, Line>;

  template <class T, class Line>
  bool IntersectBricks(const Sets& sets, const Line& line, double enter, double leave, Hit& hit,
    double gradient[3]) const;

  /// Searches the brick of the walk for all isovalues of its range; `hasGradient`: the gradient was found too, as
  /// it is when its samples are all in the brick.
  template <class T, class Line>
  bool IntersectBrick(const Sets& sets, const Line& line, const Walk<Line>& walk, CellHit& cell,
    int& isovalue, double gradient[3], bool& hasGradient) const;

  /// Calls `isDone(sample, traversal, range, walk)` for the bricks on the ray, front to back, until it
  /// returns true; returns whether it did. `sample` has the type of the samples; `range` is that of the
  /// brick's values.
  template <class IsDone>
  bool SearchBricks(const Sets& sets, const Ray& ray, const IsDone& isDone) const;

  Store& Blocks;
  typename Store::Worker& Self;
};

} // namespace rt

#include "DSMRayTracing/field/lattice/IsosurfaceSearch.txx"

#endif
