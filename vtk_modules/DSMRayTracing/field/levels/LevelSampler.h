// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelSampler_h
#define rt_LevelSampler_h

#include "DSMBricks/levels/LevelVoxels.h"
#include "DSMRayTracing/field/lattice/LatticePlace.h"
#include "DSMRayTracing/field/levels/LevelField.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <vector>

namespace rt
{

/// Reads values of levels through a store, at a batch of places: those of `places` that are `wanted`, of as many as
/// MaxRays. A place is in the index space of its brick's level. Pure. One for each worker: it holds at most one
/// pin, and none while it acquires or when a call returns. May wait for bricks. All fields of a dataset whose
/// arrays are in all of its blocks have the same bricks; where a field has none with that number and box, there are
/// no values.
template <class Store>
class LevelSampler
{
public:
  LevelSampler(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
  {
  }

  /// Finds the leaf that a point in world space is in; false where there is none.
  bool FindPlace(const LevelField& field, const glm::dvec3& point, LatticePlace& place) const
  {
    return this->FindLeaf(*field.Voxels, field.ToIndex(point), place);
  }
  /// Finds the leaves of places that are points in the index space of level 0 so far; returns those that have one.
  RayMask FindPlaces(const bricks::LevelVoxels& field, LatticePlace* places, RayMask wanted) const
  {
    return FindRays(wanted,
      [&](int index)
      { return this->FindLeaf(field, glm::dvec3(places[index].IndexPoint), places[index]); });
  }

  /// NaN where there are no data. Returns the places that are in cells that are there.
  RayMask FindValues(const bricks::LevelVoxels& field, const LatticePlace* places, RayMask wanted,
    double* values) const;

  /// The same, but the value of the nearest point of the cell.
  RayMask FindNearestValues(const bricks::LevelVoxels& field, const LatticePlace* places,
    RayMask wanted, double* values) const;

  /// How fast the trilinear value of the place's cell grows on each axis of the index space of level 0.
  void FindGradients(const bricks::LevelVoxels& field, const LatticePlace* places, RayMask wanted,
    glm::dvec3* gradients) const;

  /// The smooth gradient there, in the index space of level 0: trilinear between central differences at the corners
  /// of the place's cell, one step of its level to each side; one-sided where there are no data.
  void FindSmoothGradient(
    const bricks::LevelVoxels& field, const LatticePlace& place, glm::dvec3& gradient) const;

  /// How fast values grow on each axis of the index space of level 0 at points in world space.
  void FindSmoothGradients(const LevelField& field, const std::vector<glm::dvec3>& points,
    std::vector<glm::dvec3>& gradients) const
  {
    for (std::size_t number = 0; number < points.size(); ++number)
    {
      LatticePlace place;
      if (this->FindPlace(field, points[number], place))
      {
        this->FindSmoothGradient(*field.Voxels, place, gradients[number]);
      }
    }
  }

  /// There are no fields of colors.
  RayMask FindColors(const bricks::LevelVoxels&, const LatticePlace*, RayMask, glm::vec4*) const
  {
    return 0;
  }

private:
  template <class T>
  class Reader;

  /// `point`: in the index space of level 0.
  bool FindLeaf(
    const bricks::LevelVoxels& field, const glm::dvec3& point, LatticePlace& place) const;

  /// `evaluate(corners, local)`
  template <class Evaluate>
  RayMask VisitCells(const bricks::LevelVoxels& field, const LatticePlace* places, RayMask wanted,
    const Evaluate& evaluate) const;

  Store& Blocks;
  typename Store::Worker& Self;
};

} // namespace rt

#include "DSMRayTracing/field/levels/LevelSampler.txx"

#endif
