// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_VolumeTracer_h
#define rt_VolumeTracer_h

#include "DSMRayTracing/ray/CellHit.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/volume/BrickAccess.h"
#include "DSMRayTracing/volume/BrickWalk.h"
#include "DSMRayTracing/volume/GridRay.h"
#include "DSMRayTracing/volume/HitGradient.h"
#include "DSMRayTracing/volume/IsosurfaceObject.h"
#include "DSMRayTracing/volume/IsovaluePredicate.h"

#include <glm/vec3.hpp>

namespace rt
{

/// Where a ray meets a surface first.
struct SurfaceHit
{
  double T = 0.0;
  /// Unit, world space; the direction in which the scalar falls (away from the larger values), as
  /// Contour's normals point.
  glm::dvec3 Normal{ 0.0 };
  int Isovalue = 0;        ///< index into IsosurfaceObject::Isovalues
  dsm::BlockId Brick = 0;  ///< the brick that holds the hit
  bool FromInside = false; ///< the ray comes from values that are not below the isovalue
  glm::dvec3 IndexPoint{ 0.0 };
};

/// Finds isosurface hits through a store (ObjectStore now; others have the same members): walks the
/// coarse macrocells front to back, acquires each brick that may hold a surface once a visit, and
/// searches it (GridTraversal). Pure: the result depends on the ray and the data only. One for each
/// worker: it holds at most one pin, and none while it acquires or when a call returns.
template <class Store, Consolidation Mode = Consolidation::PerBrick>
class VolumeTracer
{
public:
  VolumeTracer(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
  {
  }

  /// The first hit in [ray.Min, ray.Max], normal included. May wait for bricks. Of several
  /// isovalues the nearest hit counts, of equally near ones the lowest isovalue.
  bool Intersect(const IsosurfaceObject& object, const Ray& ray, SurfaceHit& hit) const;

  /// Whether there is any hit in [ray.Min, ray.Max]: whether Intersect finds one. May wait for
  /// bricks.
  bool IsOccluded(const IsosurfaceObject& object, const Ray& ray) const;

  /// The trilinear value of a field at a point in index space; NaN where it holds no data.
  double Sample(const VoxelField& field, const glm::dvec3& indexPoint) const;

private:
  using Walk = BrickWalk<IsovaluePredicate>;

  template <class T>
  bool IntersectBricks(const IsosurfaceObject& object, const GridRay& line, double enter,
    double leave, SurfaceHit& hit, double gradient[3]) const;

  /// Searches the brick of the walk for all isovalues of its range; `hasGradient` tells that the
  /// gradient was found too, as it is when its samples are all in the brick.
  template <class T>
  bool IntersectBrick(const IsosurfaceObject& object, const GridRay& line, const Walk& walk,
    CellHit& cell, int& isovalue, double gradient[3], bool& hasGradient) const;

  template <class T>
  bool IsOccludedInBrick(
    const IsosurfaceObject& object, const GridRay& line, const Walk& walk) const;

  template <class T>
  double SampleCell(
    const VoxelField& field, const Index3& cell, const glm::dvec3& indexPoint) const;

  Store& Blocks;
  typename Store::Worker& Self;
};

} // namespace rt

#include "DSMRayTracing/volume/VolumeTracer.txx"

#endif
