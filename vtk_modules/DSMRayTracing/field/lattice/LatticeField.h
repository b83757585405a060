// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticeField_h
#define rt_LatticeField_h

#include "DSMBricks/layout/VoxelField.h"
#include "DSMRayTracing/field/grid/IndexSpace.h"
#include "DSMRayTracing/field/lattice/IndexedField.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace rt
{

class ObjectDigest;
template <class Store>
class LatticeMedia;
template <class Store>
class LatticeSampler;
template <class Store>
class LatticeSurfaces;
class LatticeSections;
template <class FieldType, class Store>
class VoxelExtrema;

/// Values at the points of a lattice, uniform or rectilinear, in bricks of voxels, and where they are in the world. A
/// kind of field: see Field.h.
struct LatticeField : IndexedField<bricks::VoxelField>
{
  template <class Store>
  using Sampler = LatticeSampler<Store>;
  template <class Store>
  using Surfaces = LatticeSurfaces<Store>;
  template <class Store>
  using Media = LatticeMedia<Store>;
  using Sections = LatticeSections;
  template <class Store>
  using Extrema = VoxelExtrema<LatticeField, Store>;

  IndexSpace GetIndexSpace() const
  {
    return IndexSpace(
      this->IndexToWorld, this->WorldToIndex, this->Voxels ? this->Voxels->Planes.get() : nullptr);
  }
  /// The unit normal, in world space, of a surface where the values grow so fast on each axis of the index space.
  glm::dvec3 GetNormal(const glm::dvec3& gradient, const glm::dvec3& rayDirection) const
  {
    return this->GetIndexSpace().GetNormal(&gradient.x, rayDirection);
  }
  /// The cell that tells which block of BlockLooks has a place.
  bricks::Index3 GetBlockCell(const LatticePlace& place) const { return place.GetCell(); }
  /// The place of a point in world space; of the nearest cell, beyond the lattice.
  LatticePlace GetPlace(const glm::dvec3& point) const;
  /// How much values grow in a cell of mean size where they grow so fast on each axis of the index space.
  double GetGrowth(const glm::dvec3& gradient) const
  {
    return this->GetGrowthInCell(gradient, glm::dvec3(1.0));
  }
  using IndexedField::FindBrick;
  /// The brick that has a place's values (world space); of no segment, outside of the lattice.
  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const;
  /// Length of a cell's shortest edge, in the space to which the matrix leads. A rectilinear grid gives that of a
  /// cell of mean size, because hits in its large cells are no more exact.
  double GetFinestLength(const glm::dmat3& worldToSpace = glm::dmat3(1.0)) const
  {
    return this->GetShortestEdge(worldToSpace, glm::dvec3(1.0));
  }
  /// All that a picture depends on.
  void AddTo(ObjectDigest& digest) const;

  /// Returns whether any positions within the field have no value.
  static bool HasHoles(const Values& values) { return values.Lattice.HasCellMask(); }
  static void AddTo(ObjectDigest& digest, const Values& values);
};

} // namespace rt

#endif
