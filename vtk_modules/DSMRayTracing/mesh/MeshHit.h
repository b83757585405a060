// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshHit_h
#define rt_MeshHit_h

#include "DSMCore/base/Block.h"
#include "DSMRayTracing/mesh/MeshInstance.h"
#include "DSMRayTracing/mesh/TriangleAttributes.h"
#include "DSMRayTracing/mesh/TriangleHit.h"
#include "DSMRayTracing/ray/Ray.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <limits>

namespace rt
{

/// First intersection of a ray with a mesh. World space; normals are unit length and not turned to
/// the viewer.
struct MeshHit
{
  double T = 0.0;
  /// Normal of the triangle's plane. The corners are counter-clockwise, in the mesh's space, seen
  /// from the side it points to (a mirroring matrix does not turn the surface inside out). Tubes and
  /// spheres: outward.
  glm::dvec3 GeometricNormal{ 0.0 };
  /// Interpolated from the points' normals; where they have none, the geometric one.
  glm::dvec3 Normal{ 0.0 };
  /// True if the ray comes from the side that the geometric normal points to.
  bool Front = true;
  double Value = 0.0;                  ///< interpolated, or the triangle's; NaN without values
  glm::dvec3 CornerValues{ 0.0 };      ///< in the order of Weights; NaN without values
  glm::vec4 Color{ 1.0f };             ///< in [0, 1], not premultiplied; white without colors
  glm::dvec2 TextureCoordinate{ 0.0 }; ///< 0 without
  /// Barycentric weights of the corners in the brick's order: the smallest position first; or along the
  /// line, for tubes.
  glm::dvec3 Weights{ 0.0 };
  glm::vec3 Corners[3]; ///< in that order, relative to the mesh's origin
  float Radius = 0.0f;  ///< the largest one of the corners, in the same units; 0 for triangles
  unsigned EdgeFlags = bricks::AllEdges;
  dsm::BlockId Brick = 0;
  std::uint32_t Triangle = 0; ///< index in the brick

  /// Sets the hit from a triangle that `ray` intersects.
  void Set(const MeshInstance& instance, const Ray& ray, const TriangleHit& triangle,
    const TriangleAttributes& attributes)
  {
    this->T = triangle.T;
    this->Front = triangle.Front;
    this->Brick = triangle.Brick;
    this->Triangle = triangle.Triangle;
    this->Weights = { triangle.Weights[0], triangle.Weights[1], triangle.Weights[2] };
    const bricks::MeshAttributes& has = instance.GetMesh().Attributes;
    this->EdgeFlags = has.Radii ? 0 : attributes.EdgeFlags;
    this->Radius = has.Radii ? attributes.GetLargestRadius() : 0.0f;

    glm::dvec3 corners[3];
    for (int corner = 0; corner < 3; ++corner)
    {
      const float* position = triangle.Corners[corner];
      this->Corners[corner] = { position[0], position[1], position[2] };
      corners[corner] = this->Corners[corner];
    }
    glm::dvec3 upright = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (has.Radii)
    {
      upright = instance.PlaceInBricks(ray.Origin + this->T * ray.Direction) -
        (this->Weights[0] * corners[0] + this->Weights[1] * corners[1] +
          this->Weights[2] * corners[2]);
    }
    upright = instance.TurnNormal(upright);
    const double length = glm::length(upright);
    this->GeometricNormal = length > 0.0 ? upright / length : -glm::normalize(ray.Direction);
    this->Normal = this->GeometricNormal;
    glm::dvec3 normal;
    if (!has.Radii && attributes.GetNormal(triangle.Weights, normal))
    {
      normal = instance.TurnNormal(normal);
      const double size = glm::length(normal);
      this->Normal = size > 0.0 ? normal / size : this->GeometricNormal;
    }

    const bool hasValues = has.Values != bricks::Attachment::None;
    const double notANumber = std::numeric_limits<double>::quiet_NaN();
    this->Value = hasValues ? attributes.GetValue(triangle.Weights) : notANumber;
    for (int corner = 0; corner < 3; ++corner)
    {
      this->CornerValues[corner] = hasValues ? attributes.Values[corner] : notANumber;
    }
    this->Color = has.Colors != bricks::Attachment::None ? attributes.GetColor(triangle.Weights)
                                                         : glm::vec4(1.0f);
    this->TextureCoordinate =
      has.TextureCoordinates ? attributes.GetTextureCoordinate(triangle.Weights) : glm::dvec2(0.0);
  }
};

} // namespace rt

#endif
