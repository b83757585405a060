// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshSearch_txx
#define rt_MeshSearch_txx

#include "DSMRayTracing/mesh/TreeletTraversal.h"
#include "DSMRayTracing/mesh/TriangleAttributes.h"
#include "DSMRayTracing/ray/ChildrenOnRay.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

namespace rt
{

template <class Store>
bool MeshSearch<Store>::Intersect(const MeshInstance& instance, const Ray& ray, MeshHit& hit) const
{
  const bricks::TriangleMesh& mesh = instance.GetMesh();
  ShearedRay line;
  if (mesh.Bricks.IsEmpty() || !instance.GetMeshRay(ray, line))
  {
    return false;
  }
  NearestTriangle nearest;
  TriangleAttributes attributes;
  TraverseWideBvh(mesh.Bricks.GetNodes(), ChildrenOnRay(line.Boxes, line.BoxesEnd),
    [&](std::uint32_t leaf)
    {
      const std::uint32_t number = bricks::BrickBvh::GetBrick(leaf);
      const typename Store::Pin pin = this->Blocks.Acquire(this->Self, *mesh.Segment, number);
      const bricks::TriangleBrick brick(pin.GetData());
      if (TreeletTraversal(brick, number, instance.Culling).Intersect(line, nearest))
      {
        attributes.Copy(brick, nearest.Hit.Triangle);
      }
    });
  if (nearest.Found)
  {
    hit.Set(instance, ray, nearest.Hit, attributes);
  }
  return nearest.Found;
}

template <class Store>
bool MeshSearch<Store>::IsOccluded(const MeshInstance& instance, const Ray& ray) const
{
  const bricks::TriangleMesh& mesh = instance.GetMesh();
  ShearedRay line;
  if (mesh.Bricks.IsEmpty() || !instance.GetMeshRay(ray, line))
  {
    return false;
  }
  bool occluded = false;
  TraverseWideBvh(mesh.Bricks.GetNodes(), ChildrenOnRay(line.Boxes, line.BoxesEnd),
    [&](std::uint32_t leaf)
    {
      const std::uint32_t number = bricks::BrickBvh::GetBrick(leaf);
      const typename Store::Pin pin = this->Blocks.Acquire(this->Self, *mesh.Segment, number);
      const bricks::TriangleBrick brick(pin.GetData());
      occluded = TreeletTraversal(brick, number, instance.Culling).IsOccluded(line) || occluded;
    });
  return occluded;
}

/// Searches the bricks that a packet meets.
template <class Store>
class MeshSearch<Store>::PacketVisitor final : public MeshKernel::Visitor
{
public:
  PacketVisitor(const MeshSearch& search, const bricks::TriangleMesh& mesh)
    : Search(search)
    , Mesh(mesh)
  {
  }

  void Visit(std::uint32_t number, RayMask rays) override
  {
    const typename Store::Pin pin =
      this->Search.Blocks.Acquire(this->Search.Self, *this->Mesh.Segment, number);
    const bricks::TriangleBrick brick(pin.GetData());
    RayMask better = this->Search.Kernel.SearchBrick(this->Packet, rays, brick, number);
    this->Found |= better;
    for (; better != 0; better &= better - 1)
    {
      const int index = GetLowest(better);
      this->Attributes[index].Copy(brick, this->Packet.Nearest[index].Hit.Triangle);
    }
  }

  MeshPacket Packet;
  RayMask Found = 0;
  TriangleAttributes Attributes[MeshPacket::Size];

private:
  const MeshSearch& Search;
  const bricks::TriangleMesh& Mesh;
};

template <class Store>
template <class Visitor>
void MeshSearch<Store>::VisitBricks(
  const MeshInstance& instance, const Ray* rays, RayMask wanted, Visitor& visitor) const
{
  const bricks::TriangleMesh& mesh = instance.GetMesh();
  if (mesh.Bricks.IsEmpty())
  {
    return;
  }
  const RayMask meeting = this->Kernel.SetRays(visitor.Packet, instance, rays, wanted);
  if (meeting != 0)
  {
    this->Kernel.FindBricks(visitor.Packet, meeting, mesh.Bricks, visitor);
  }
}

template <class Store>
template <class Take>
RayMask MeshSearch<Store>::Intersect(
  const MeshInstance& instance, const Ray* rays, RayMask wanted, const Take& take) const
{
  if (GetCount(wanted) < LeastPacket)
  {
    return FindRays(wanted,
      [&](int index)
      {
        MeshHit hit;
        const bool isHit = this->Intersect(instance, rays[index], hit);
        if (MeshHit* const place = isHit ? take(index, hit.T) : nullptr)
        {
          *place = hit;
        }
        return isHit;
      });
  }
  PacketVisitor visitor(*this, instance.GetMesh());
  this->VisitBricks(instance, rays, wanted, visitor);
  ForEachRay(visitor.Found,
    [&](int index)
    {
      const TriangleHit& triangle = visitor.Packet.Nearest[index].Hit;
      if (MeshHit* const hit = take(index, triangle.T))
      {
        hit->Set(instance, rays[index], triangle, visitor.Attributes[index]);
      }
    });
  return visitor.Found;
}

/// Searches the bricks that a packet meets for any hit.
template <class Store>
class MeshSearch<Store>::OcclusionVisitor final : public MeshKernel::Visitor
{
public:
  OcclusionVisitor(const MeshSearch& search, const bricks::TriangleMesh& mesh)
    : Search(search)
    , Mesh(mesh)
  {
  }

  void Visit(std::uint32_t number, RayMask rays) override
  {
    const typename Store::Pin pin =
      this->Search.Blocks.Acquire(this->Search.Self, *this->Mesh.Segment, number);
    this->Found |=
      this->Search.Kernel.FindOccluded(this->Packet, rays, bricks::TriangleBrick(pin.GetData()));
  }

  MeshPacket Packet;
  RayMask Found = 0;

private:
  const MeshSearch& Search;
  const bricks::TriangleMesh& Mesh;
};

template <class Store>
RayMask MeshSearch<Store>::FindOccluded(
  const MeshInstance& instance, const Ray* rays, RayMask wanted) const
{
  if (GetCount(wanted) < LeastPacket)
  {
    return FindRays(wanted, [&](int index) { return this->IsOccluded(instance, rays[index]); });
  }
  OcclusionVisitor visitor(*this, instance.GetMesh());
  this->VisitBricks(instance, rays, wanted, visitor);
  return visitor.Found;
}

} // namespace rt

#endif
