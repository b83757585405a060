// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelField_h
#define rt_LevelField_h

#include "DSMBricks/levels/LevelVoxels.h"
#include "DSMRayTracing/field/grid/IndexSpace.h"
#include "DSMRayTracing/field/lattice/IndexedField.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace rt
{

class ObjectDigest;
template <class Store>
class LevelMedia;
template <class Store>
class LevelSampler;
class LevelSections;
template <class Store>
class LevelSurfaces;
template <class FieldType, class Store>
class VoxelExtrema;

/// Values at the points of lattices of several levels, as of AMR and of hyper tree grids: one continuous function, see
/// bricks::LevelNodes. A kind of field: see Field.h. A Place is in the index space of its brick's
/// level, all else in that of level 0.
struct LevelField : IndexedField<bricks::LevelVoxels>
{
  template <class Store>
  using Sampler = LevelSampler<Store>;
  template <class Store>
  using Surfaces = LevelSurfaces<Store>;
  template <class Store>
  using Media = LevelMedia<Store>;
  template <class Store>
  using Extrema = VoxelExtrema<LevelField, Store>;
  using Sections = LevelSections;

  IndexSpace GetIndexSpace() const { return IndexSpace(this->IndexToWorld, this->WorldToIndex); }
  /// The unit normal, in world space, of a surface where the values grow so fast on each axis of the index space.
  glm::dvec3 GetNormal(const glm::dvec3& gradient, const glm::dvec3& rayDirection) const
  {
    return this->GetIndexSpace().GetNormal(&gradient.x, rayDirection);
  }
  /// The cell of level 0 that tells which block of BlockLooks has a place.
  bricks::Index3 GetBlockCell(const LatticePlace& place) const;
  /// Finds a point (world space) within the bounds of all cells, in the index space of level 0; a point on their
  /// border is within. Its cell is not known yet.
  bool FindPlace(const glm::dvec3& point, LatticePlace& place) const;
  /// How much values grow in a cell of the finest level, of mean size, where they grow so fast on each axis of the
  /// index space.
  double GetGrowth(const glm::dvec3& gradient) const
  {
    return this->GetGrowthInCell(gradient, this->GetFinestScale());
  }
  using IndexedField::FindBrick;
  /// A brick that has a place (world space) in its box, of the finest level of such; of no segment, where none is.
  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const;
  /// Length of the shortest edge of a cell of the finest level, in the space to which the matrix leads.
  double GetFinestLength(const glm::dmat3& worldToSpace = glm::dmat3(1.0)) const
  {
    return this->GetShortestEdge(worldToSpace, this->GetFinestScale());
  }
  /// All that a picture depends on.
  void AddTo(ObjectDigest& digest) const;

  /// Returns whether any positions within the field have no value.
  static bool HasHoles(const Values&) { return true; }
  static void AddTo(ObjectDigest& digest, const Values& values);

private:
  /// Cells of the finest level in one of level 0.
  glm::dvec3 GetFinestScale() const
  {
    const bricks::LevelScales& scales = this->Voxels->Lattice.GetScales();
    return glm::dvec3(scales.Get(scales.GetCount() - 1));
  }
};

} // namespace rt

#endif
