// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshInstance_h
#define rt_MeshInstance_h

#include "DSMBricks/layout/TriangleMesh.h"
#include "DSMRayTracing/ray/Ray.h"
#include "DSMRayTracing/ray/ShearedRay.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <utility>

namespace rt
{

/// Which sides of a surface are not shown.
struct MeshCulling
{
  bool Front = false;
  bool Back = false;
};

/// A mesh at its place in the world, with what every ray needs of it.
class MeshInstance
{
public:
  /// `meshToWorld` is affine and invertible.
  MeshInstance(std::shared_ptr<const bricks::TriangleMesh> mesh, const glm::dmat4& meshToWorld)
    : Shape(std::move(mesh))
    , MeshToWorld(meshToWorld)
    , BricksToWorld(this->Shape->Scale * glm::dmat3(meshToWorld))
    , WorldOrigin(meshToWorld * glm::dvec4(this->Shape->Origin, 1.0))
    , WorldToBricks(glm::inverse(this->BricksToWorld))
    , NormalToWorld(glm::transpose(glm::inverse(glm::dmat3(meshToWorld))))
    , AxisLengths(glm::length(this->BricksToWorld[0]), glm::length(this->BricksToWorld[1]),
        glm::length(this->BricksToWorld[2]))
  {
  }

  MeshCulling Culling;

  const bricks::TriangleMesh& GetMesh() const { return *this->Shape; }
  const glm::dmat4& GetMeshToWorld() const { return this->MeshToWorld; }

  /// World length that two triangles can at most be apart, near these corners, for the rounding of
  /// corners to what bricks hold alone: nearer ones cannot be told apart. `radius`: of tubes, or 0.
  double GetResolution(const glm::vec3 corners[3], float radius) const
  {
    const glm::vec3 farthest =
      glm::max(glm::max(glm::abs(corners[0]), glm::abs(corners[1])), glm::abs(corners[2])) + radius;
    return CornerStep * glm::dot(glm::dvec3(farthest), this->AxisLengths);
  }

  /// The same T in both spaces. False when the ray cannot hit the mesh.
  bool GetMeshRay(const Ray& ray, ShearedRay& line) const
  {
    // Subtracting first keeps the digits of a small mesh far from the world's origin.
    const glm::dvec3 origin = this->WorldToBricks * (ray.Origin - this->WorldOrigin);
    const glm::dvec3 direction = this->WorldToBricks * ray.Direction;
    return line.Set(
      &origin.x, &direction.x, ray.Min, ray.Max, &this->Shape->Lower.x, &this->Shape->Upper.x);
  }

  /// The steps of GetMeshRay: world, less this point, times this matrix.
  const glm::dvec3& GetWorldOrigin() const { return this->WorldOrigin; }
  const glm::dmat3& GetWorldToBricks() const { return this->WorldToBricks; }

  /// A world place as bricks would have it.
  glm::dvec3 PlaceInBricks(const glm::dvec3& position) const
  {
    return this->WorldToBricks * (position - this->WorldOrigin);
  }

  /// World place of a corner as bricks have it.
  glm::dvec3 Place(const glm::vec3& corner) const
  {
    return this->WorldOrigin + this->BricksToWorld * glm::dvec3(corner);
  }

  /// Turns a normal of the mesh's space, of any length, to the world.
  glm::dvec3 TurnNormal(const glm::dvec3& normal) const { return this->NormalToWorld * normal; }

private:
  /// Corners are floats: each of two may be off by half of this part of its coordinates.
  static constexpr double CornerStep = 0x1p-23;

  std::shared_ptr<const bricks::TriangleMesh> Shape;
  glm::dmat4 MeshToWorld;
  glm::dmat3 BricksToWorld; ///< for positions in bricks, less their origin
  glm::dvec3 WorldOrigin;   ///< origin of the positions in bricks
  glm::dmat3 WorldToBricks;
  glm::dmat3 NormalToWorld;
  glm::dvec3 AxisLengths; ///< in the world, of the bricks' units along the mesh's axes
};

} // namespace rt

#endif
