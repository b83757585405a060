// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticeSampler_h
#define rt_LatticeSampler_h

#include "DSMBricks/layout/VoxelField.h"
#include "DSMRayTracing/base/Lanes.h"
#include "DSMRayTracing/field/lattice/LatticeField.h"
#include "DSMRayTracing/field/lattice/LatticePlace.h"
#include "DSMRayTracing/ray/CellHit.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <vector>

namespace rt
{

/// Reads values of a lattice through a store, at a batch of places: those of `places` that are `wanted`, of as many as
/// MaxRays. Places in the same brick are read together. Pure. One for each worker: it holds at most one pin, and none
/// while it acquires or when a call returns. May wait for bricks.
///
/// Values of points are interpolated, and read at LatticePlace::IndexPoint; those of cells (BrickLattice::IsOfCells)
/// are the cell's.
template <class Store>
class LatticeSampler
{
public:
  LatticeSampler(Store& store, typename Store::Worker& worker)
    : Blocks(store)
    , Self(worker)
  {
  }

  /// The place of a point in world space; always found: of the nearest cell, beyond the lattice.
  bool FindPlace(const LatticeField& field, const glm::dvec3& point, LatticePlace& place) const
  {
    place = field.GetPlace(point);
    return true;
  }
  /// Places are whole.
  RayMask FindPlaces(const bricks::VoxelField&, LatticePlace*, RayMask wanted) const
  {
    return wanted;
  }

  /// NaN where there are no data; infinite between infinite values of one sign. Returns the places that are in
  /// cells that are there, whatever the values of these.
  RayMask FindValues(const bricks::VoxelField& field, const LatticePlace* places, RayMask wanted,
    double* values) const;

  /// The same, but of points the value of the nearest one in the cell that FindValues takes.
  RayMask FindNearestValues(const bricks::VoxelField& field, const LatticePlace* places,
    RayMask wanted, double* values) const;

  /// How fast the trilinear value grows on each axis of the index (or grid) space, in cells that hold data.
  void FindGradients(const bricks::VoxelField& field, const LatticePlace* places, RayMask wanted,
    glm::dvec3* gradients) const;

  /// How fast values grow on each axis of the index (or grid) space at points in world space:
  /// CellNeighbourhood::GetGradient.
  void FindSmoothGradients(const LatticeField& field, const std::vector<glm::dvec3>& points,
    std::vector<glm::dvec3>& gradients) const;

  /// Samples fields of colors (PackedColor), each channel separately. Returns the places that have
  /// data.
  RayMask FindColors(const bricks::VoxelField& field, const LatticePlace* places, RayMask wanted,
    glm::vec4* colors) const;

private:
  template <class T>
  class Reader;
  /// A smooth gradient to be found.
  struct Asked
  {
    dsm::BlockId Brick;
    CellHit Cell;
    std::size_t Number;
  };
  enum class Corners
  {
    Finite, ///< corners of a cell that holds data
    Any     ///< corners of any existing cell
  };

  /// Calls `visit(reader, index)` for the wanted places, those of a brick one after the other.
  template <class T, class Visit>
  void VisitPlaces(const bricks::VoxelField& field, const LatticePlace* places, RayMask wanted,
    const Visit& visit) const;

  /// `evaluate(corners, local)`: of the values at a cell's corners, and where in it the point is; NaN without data.
  template <class Evaluate>
  RayMask FindValues(const bricks::VoxelField& field, const LatticePlace* places, RayMask wanted,
    double* values, const Evaluate& evaluate) const;

  static void FindCell(const LatticeField& field, const glm::dvec3& point, Asked& asked);
  /// Finds smooth gradients at positions in the same brick. Returns the positions whose samples are not all in the
  /// brick.
  template <class T, class Iterator>
  std::vector<const Asked*> FindGradientsWithin(const LatticeField& field, Iterator begin,
    Iterator end, std::vector<glm::dvec3>& gradients) const;

  Store& Blocks;
  typename Store::Worker& Self;
};

} // namespace rt

#include "DSMRayTracing/field/lattice/LatticeSampler.txx"

#endif
