// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_CellField_h
#define rt_CellField_h

#include "DSMBricks/cells/CellBricks.h"
#include "DSMRayTracing/field/Field.h"
#include "DSMRayTracing/field/grid/IndexSpace.h"
#include "DSMRayTracing/field/lattice/IndexedField.h"
#include "DSMRayTracing/object/ObjectTracer.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

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
inline constexpr double ClearancePart<CellField> = 0.5;

/// Values at the points of cells of any shape, as of curvilinear and unstructured grids. Cells are split into
/// tetrahedra, alike on both sides of each face (bricks::SplitHexahedron), in which values are linear. A kind of field:
/// see Field.h.
struct CellField
  : WalkedField<CellField>
  , IndexedField<bricks::CellValues, CellPlace>
{
  static constexpr bool WalksTogether = true;
  template <class Store>
  using Walk = CellWalk<Store>;
  template <class Store>
  using Sampler = CellSampler<Store>;
  template <class Store>
  using Surfaces = CellSurfaces<Store>;
  template <class Store>
  using Media = CellMedia<Store>;

  using IndexedField::FindBrick;
  using IndexedField::GetSegment;
  /// The first brick that has a place (world space) in its box; of no segment, where none has.
  ObjectTracer::Brick FindBrick(const glm::dvec3& place) const;
  bool FindPlace(const glm::dvec3& point, CellPlace& place) const;
  void MovePlace(const glm::dvec3& point, CellPlace& place) const
  {
    place.Point = this->ToIndex(point);
  }
  glm::dvec3 GetNormal(const glm::dvec3& gradient, const glm::dvec3& rayDirection) const
  {
    return IndexSpace(this->IndexToWorld, this->WorldToIndex).GetNormal(&gradient.x, rayDirection);
  }
  double GetFinestLength(const glm::dmat3& worldToSpace = glm::dmat3(1.0)) const;
  double GetGrowth(const glm::dvec3& gradient) const;
  void AddTo(ObjectDigest& digest) const;

  static bool HasHoles(const Values&) { return true; }
  static void AddTo(ObjectDigest& digest, const Values& values);
};

} // namespace rt

#endif
