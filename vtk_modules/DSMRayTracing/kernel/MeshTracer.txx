// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshTracer_txx
#define rt_MeshTracer_txx

#include "DSMRayTracing/kernel/WideBvhTraversal.h"

#include <glm/geometric.hpp>

#include <limits>

namespace rt
{

template <class Store>
bool MeshTracer<Store>::Intersect(const MeshInstance& instance, const Ray& ray, MeshHit& hit) const
{
  const TriangleMesh& mesh = instance.GetMesh();
  MeshRay line;
  if (mesh.Bricks.IsEmpty() || !instance.GetMeshRay(ray, line))
  {
    return false;
  }
  TreeletTraversal traversal(line, instance.Culling);
  TriangleAttributes attributes;
  TraverseWideBvh(mesh.Bricks.GetNodes(), line.Boxes, line.BoxesEnd,
    [&](std::uint32_t leaf)
    {
      const dsm::BlockId id = BrickBvh::GetBrick(leaf);
      const typename Store::Pin pin = this->Blocks.Acquire(this->Self, *mesh.Segment, id);
      const TriangleBrick brick(pin.GetData());
      if (traversal.Intersect(brick))
      {
        attributes.Copy(brick, traversal.GetHit().Triangle);
        hit.Brick = id;
      }
    });
  if (!traversal.HasHit())
  {
    return false;
  }
  Complete(instance, ray, traversal.GetHit(), attributes, hit);
  return true;
}

template <class Store>
void MeshTracer<Store>::Complete(const MeshInstance& instance, const Ray& ray,
  const TriangleHit& triangle, const TriangleAttributes& attributes, MeshHit& hit)
{
  hit.T = triangle.T;
  hit.Front = triangle.Front;
  hit.Triangle = triangle.Triangle;
  hit.Weights = { triangle.Weights[0], triangle.Weights[1], triangle.Weights[2] };

  glm::dvec3 corners[3];
  for (int corner = 0; corner < 3; ++corner)
  {
    const float* position = triangle.Corners[corner];
    corners[corner] = { position[0], position[1], position[2] };
  }
  const glm::dvec3 plane =
    instance.TurnNormal(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double length = glm::length(plane);
  hit.GeometricNormal = length > 0.0 ? plane / length : -glm::normalize(ray.Direction);
  hit.Normal = hit.GeometricNormal;
  glm::dvec3 normal;
  if (attributes.GetNormal(triangle.Weights, normal))
  {
    normal = instance.TurnNormal(normal);
    const double size = glm::length(normal);
    hit.Normal = size > 0.0 ? normal / size : hit.GeometricNormal;
  }

  const MeshAttributes& has = instance.GetMesh().Attributes;
  const bool hasValues = has.Values != Attachment::None;
  const double notANumber = std::numeric_limits<double>::quiet_NaN();
  hit.Value = hasValues ? attributes.GetValue(triangle.Weights) : notANumber;
  for (int corner = 0; corner < 3; ++corner)
  {
    hit.CornerValues[corner] = hasValues ? attributes.Values[corner] : notANumber;
  }
  hit.Color =
    has.Colors != Attachment::None ? attributes.GetColor(triangle.Weights) : glm::vec4(1.0f);
  hit.TextureCoordinate =
    has.TextureCoordinates ? attributes.GetTextureCoordinate(triangle.Weights) : glm::dvec2(0.0);
}

} // namespace rt

#endif
