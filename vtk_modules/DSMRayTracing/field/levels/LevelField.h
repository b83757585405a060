// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LevelField_h
#define rt_LevelField_h

#include "DSMBricks/levels/LevelVoxels.h"
#include "DSMRayTracing/field/Field.h"
#include "DSMRayTracing/field/lattice/IndexSpace.h"
#include "DSMRayTracing/field/lattice/LatticePlace.h"
#include "DSMRayTracing/object/ObjectTracer.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <memory>

namespace rt
{

class ObjectDigest;
template <class Store>
class LevelExtrema;
template <class Store>
class LevelMedia;
template <class Store>
class LevelSampler;
template <class Store>
class LevelSurfaces;

/// Values at the points of lattices of several levels, as of AMR and of hyper tree grids: one continuous function, see
/// bricks::LevelNodes. A kind of field: see Field.h. A Place is in the index space of its brick's
/// level, all else in that of level 0.
struct LevelField : WalkedField<LevelField>
{
  using Values = bricks::LevelVoxels;
  using Place = LatticePlace;
  template <class Store>
  using Sampler = LevelSampler<Store>;
  template <class Store>
  using Surfaces = LevelSurfaces<Store>;
  template <class Store>
  using Media = LevelMedia<Store>;
  template <class Store>
  using Extrema = LevelExtrema<Store>;

  /// Point index space of level 0 to world; affine, invertible.
  glm::dmat4 IndexToWorld{ 1.0 };
  /// Its inverse; SetIndexToWorld keeps the two together.
  glm::dmat4 WorldToIndex{ 1.0 };
  void SetIndexToWorld(const glm::dmat4& matrix)
  {
    this->IndexToWorld = matrix;
    this->WorldToIndex = glm::inverse(matrix);
  }
  std::shared_ptr<const Values> Voxels;
  const Values& GetValues() const { return *this->Voxels; }

  IndexSpace GetIndexSpace() const { return IndexSpace(this->IndexToWorld, this->WorldToIndex); }
  /// The unit normal, in world space, of a surface where the values grow so fast on each axis of the index space.
  glm::dvec3 GetNormal(const glm::dvec3& gradient, const glm::dvec3& rayDirection) const
  {
    return this->GetIndexSpace().GetNormal(&gradient.x, rayDirection);
  }
  /// The cell of level 0 that tells which block of BlockLooks has a place.
  bricks::Index3 GetBlockCell(const LatticePlace& place) const;
  /// A point in world space, in the index space of level 0.
  glm::dvec3 ToIndex(const glm::dvec3& point) const
  {
    return glm::dmat3(this->WorldToIndex) * (point - glm::dvec3(this->IndexToWorld[3]));
  }
  /// Finds a point (world space) within the bounds of all cells, in the index space of level 0; a point on their
  /// border is within. Its cell is not known yet.
  bool FindPlace(const glm::dvec3& point, LatticePlace& place) const;
  /// How much values grow in a cell of the finest level, of mean size, where they grow so fast on each axis of the
  /// index space.
  double GetGrowth(const glm::dvec3& gradient) const;
  static const dsm::BlockSegment* GetSegment(const Values& values) { return values.Segment.get(); }
  /// The brick of a place.
  ObjectTracer::Brick FindBrick(const LatticePlace& place) const
  {
    return { this->Voxels->Segment.get(), place.Brick };
  }
  /// A brick that has a place (world space) in its box, of the finest level of such; of no segment, where none is.
  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const;
  /// Length of the shortest edge of a cell of the finest level, in the space to which the matrix leads.
  double GetFinestLength(const glm::dmat3& worldToSpace = glm::dmat3(1.0)) const;
  /// All that a picture depends on.
  void AddTo(ObjectDigest& digest) const;

  /// Returns whether any positions within the field have no value.
  static bool HasHoles(const Values&) { return true; }
  static void AddTo(ObjectDigest& digest, const Values& values);
};

} // namespace rt

#endif
