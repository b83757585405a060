// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_IndexedField_h
#define rt_IndexedField_h

#include "DSMCore/publish/BlockSegment.h"
#include "DSMRayTracing/field/lattice/LatticePlace.h"
#include "DSMRayTracing/object/ObjectTracer.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <memory>

namespace rt
{

/// Base of the fields whose values are in bricks: values, and where they are in the world. The space of bricks of cells
/// is called index space here, too.
template <class ValuesType, class PlaceType = LatticePlace>
struct IndexedField
{
  using Values = ValuesType;
  using Place = PlaceType;

  /// Point index space (sample (i,j,k) at (i,j,k) of the lattice, or of level 0) to world; affine, invertible.
  /// Where the values have Planes, it is grid space instead of index space, here and in what is called so below.
  glm::dmat4 IndexToWorld{ 1.0 };
  /// Its inverse; SetIndexToWorld keeps the two together.
  glm::dmat4 WorldToIndex{ 1.0 };
  void SetIndexToWorld(const glm::dmat4& matrix)
  {
    this->IndexToWorld = matrix;
    this->WorldToIndex = glm::inverse(matrix);
  }
  /// A point in world space, in index space.
  glm::dvec3 ToIndex(const glm::dvec3& point) const
  {
    return glm::dmat3(this->WorldToIndex) * (point - glm::dvec3(this->IndexToWorld[3]));
  }
  std::shared_ptr<const Values> Voxels;
  const Values& GetValues() const { return *this->Voxels; }

  static const dsm::BlockSegment* GetSegment(const Values& values) { return values.Segment.get(); }
  /// The brick of a place.
  ObjectTracer::Brick FindBrick(const Place& place) const
  {
    return { this->Voxels->Segment.get(), place.Brick };
  }

protected:
  /// Length of the shortest edge of a cell, in the space to which the matrix leads. `cells`: on each axis of a unit
  /// of the index space.
  double GetShortestEdge(const glm::dmat3& worldToSpace, const glm::dvec3& cells) const
  {
    const glm::dvec3 edges = GetLengths(worldToSpace * glm::dmat3(this->IndexToWorld)) / cells;
    return std::min({ edges.x, edges.y, edges.z });
  }
  /// How much values grow in a cell of mean size where they grow so fast on each axis of the index space.
  double GetGrowthInCell(const glm::dvec3& gradient, const glm::dvec3& cells) const
  {
    const glm::dvec3 lengths = GetLengths(glm::dmat3(this->IndexToWorld));
    const glm::dvec3 edges = lengths / cells;
    return glm::length(gradient / lengths) * ((edges.x + edges.y + edges.z) / 3.0);
  }

private:
  static glm::dvec3 GetLengths(const glm::dmat3& axes)
  {
    return { glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]) };
  }
};

} // namespace rt

#endif
