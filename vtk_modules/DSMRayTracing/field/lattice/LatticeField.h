// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_LatticeField_h
#define rt_LatticeField_h

#include "DSMBricks/layout/VoxelField.h"
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
class LatticeExtrema;
template <class Store>
class LatticeMedia;
template <class Store>
class LatticeSampler;
template <class Store>
class LatticeSurfaces;
class LatticeSections;

/// Values at the points of a lattice, uniform or rectilinear, in bricks of voxels, and where they are in the world. A
/// kind of field: see Field.h.
struct LatticeField
{
  using Values = bricks::VoxelField;
  using Place = LatticePlace;
  template <class Store>
  using Sampler = LatticeSampler<Store>;
  template <class Store>
  using Surfaces = LatticeSurfaces<Store>;
  template <class Store>
  using Media = LatticeMedia<Store>;
  using Sections = LatticeSections;
  template <class Store>
  using Extrema = LatticeExtrema<Store>;

  /// Point index space (sample (i,j,k) at (i,j,k) of the lattice) to world; affine, invertible. Where Voxels has
  /// Planes, it is grid space instead of index space, here and in what is called so below.
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
  double GetGrowth(const glm::dvec3& gradient) const;
  static const dsm::BlockSegment* GetSegment(const Values& values) { return values.Segment.get(); }
  /// The brick of a place.
  ObjectTracer::Brick FindBrick(const LatticePlace& place) const
  {
    return { this->Voxels->Segment.get(), place.Brick };
  }
  /// The brick that has a place's values (world space); of no segment, outside of the lattice.
  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const;
  /// Length of a cell's shortest edge, in the space to which the matrix leads. A rectilinear grid gives that of a
  /// cell of mean size, because hits in its large cells are no more exact.
  double GetFinestLength(const glm::dmat3& worldToSpace = glm::dmat3(1.0)) const;
  /// All that a picture depends on.
  void AddTo(ObjectDigest& digest) const;

  /// Returns whether any positions within the field have no value.
  static bool HasHoles(const Values& values) { return values.Lattice.HasCellMask(); }
  static void AddTo(ObjectDigest& digest, const Values& values);
};

} // namespace rt

#endif
