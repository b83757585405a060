// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellField_h
#define rt_CellField_h

#include "DSMBricks/cells/CellBricks.h"
#include "DSMCore/publish/BlockSegment.h"
#include "DSMRayTracing/field/Field.h"
#include "DSMRayTracing/object/ObjectTracer.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>

namespace rt
{

class ObjectDigest;
template <class Store>
class CellMedia;
template <class Store>
class CellSampler;
template <class Store>
class CellSurfaces;
template <class Store>
class CellWalk;

/// A place among the tetrahedra that cells are split into. Plain.
struct CellPlace
{
  static constexpr std::uint32_t NoBrick = ~std::uint32_t(0);

  glm::dvec3 Point;         ///< in the space of the bricks
  std::uint32_t Brick;      ///< NoBrick: not known yet
  std::uint16_t Corners[4]; ///< numbers of the tetrahedron's points in the brick
};

struct CellField;
template <>
constexpr double ClearancePart<CellField> = 0.5;

/// Values at the points of cells of any shape, as of curvilinear and unstructured grids. Cells are split into
/// tetrahedra, alike on both sides of each face (bricks::SplitHexahedron), in which values are linear. A kind of field:
/// see Field.h.
struct CellField : WalkedField<CellField>
{
  static constexpr bool WalksTogether = true;
  using Values = bricks::CellValues;
  using Place = CellPlace;
  template <class Store>
  using Walk = CellWalk<Store>;
  template <class Store>
  using Sampler = CellSampler<Store>;
  template <class Store>
  using Surfaces = CellSurfaces<Store>;
  template <class Store>
  using Media = CellMedia<Store>;

  /// From the space of the bricks to world; affine, invertible.
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

  static const dsm::BlockSegment* GetSegment(const Values& values) { return values.Segment.get(); }
  ObjectTracer::Brick FindBrick(const CellPlace& place) const
  {
    return { this->Voxels->Segment.get(), place.Brick };
  }
  /// The first brick that has a place (world space) in its box; of no segment, where none has.
  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const;
  /// A point in world space, in the space of the bricks.
  glm::dvec3 ToIndex(const glm::dvec3& point) const
  {
    return glm::dmat3(this->WorldToIndex) * (point - glm::dvec3(this->IndexToWorld[3]));
  }
  bool FindPlace(const glm::dvec3& point, CellPlace& place) const;
  void MovePlace(const glm::dvec3& point, CellPlace& place) const
  {
    place.Point = this->ToIndex(point);
  }
  glm::dvec3 GetNormal(const glm::dvec3& gradient, const glm::dvec3& rayDirection) const;
  double GetFinestLength(const glm::dmat3& worldToSpace = glm::dmat3(1.0)) const;
  double GetGrowth(const glm::dvec3& gradient) const;
  void AddTo(ObjectDigest& digest) const;

  static bool HasHoles(const Values&) { return true; }
  static void AddTo(ObjectDigest& digest, const Values& values);
};

} // namespace rt

#endif
