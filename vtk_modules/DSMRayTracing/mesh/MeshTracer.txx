// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_MeshTracer_txx
#define rt_MeshTracer_txx

#include "DSMRayTracing/mesh/TreeletTraversal.h"
#include "DSMRayTracing/mesh/TriangleAttributes.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

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
  NearestTriangle nearest;
  TriangleAttributes attributes;
  TraverseWideBvh(mesh.Bricks.GetNodes(), line.Boxes, line.BoxesEnd,
    [&](std::uint32_t leaf)
    {
      const std::uint32_t number = BrickBvh::GetBrick(leaf);
      const typename Store::Pin pin = this->Blocks.Acquire(this->Self, *mesh.Segment, number);
      const TriangleBrick brick(pin.GetData());
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
bool MeshTracer<Store>::IsOccluded(const MeshInstance& instance, const Ray& ray) const
{
  const TriangleMesh& mesh = instance.GetMesh();
  MeshRay line;
  if (mesh.Bricks.IsEmpty() || !instance.GetMeshRay(ray, line))
  {
    return false;
  }
  bool occluded = false;
  TraverseWideBvh(mesh.Bricks.GetNodes(), line.Boxes, line.BoxesEnd,
    [&](std::uint32_t leaf)
    {
      const std::uint32_t number = BrickBvh::GetBrick(leaf);
      const typename Store::Pin pin = this->Blocks.Acquire(this->Self, *mesh.Segment, number);
      const TriangleBrick brick(pin.GetData());
      occluded = TreeletTraversal(brick, number, instance.Culling).IsOccluded(line) || occluded;
    });
  return occluded;
}

/// Searches the bricks that a packet meets.
template <class Store>
class MeshTracer<Store>::PacketVisitor final : public MeshKernel::Visitor
{
public:
  PacketVisitor(const MeshTracer& tracer, const TriangleMesh& mesh)
    : Tracer(tracer)
    , Mesh(mesh)
  {
  }

  void Visit(std::uint32_t number, MeshPacket::Mask rays) override
  {
    const typename Store::Pin pin =
      this->Tracer.Blocks.Acquire(this->Tracer.Self, *this->Mesh.Segment, number);
    const TriangleBrick brick(pin.GetData());
    MeshPacket::Mask better = this->Tracer.Kernel.SearchBrick(this->Packet, rays, brick, number);
    this->Found |= better;
    for (; better != 0; better &= better - 1)
    {
      const int index = GetLowest(better);
      this->Attributes[index].Copy(brick, this->Packet.Nearest[index].Hit.Triangle);
    }
  }

  MeshPacket Packet;
  MeshPacket::Mask Found = 0;
  TriangleAttributes Attributes[MeshPacket::Size];

private:
  const MeshTracer& Tracer;
  const TriangleMesh& Mesh;
};

template <class Store>
MeshPacket::Mask MeshTracer<Store>::Intersect(
  const MeshInstance& instance, const Ray* rays, MeshPacket::Mask wanted, MeshHit* hits) const
{
  const TriangleMesh& mesh = instance.GetMesh();
  if (mesh.Bricks.IsEmpty())
  {
    return 0;
  }
  PacketVisitor visitor(*this, mesh);
  MeshPacket::Mask alone = 0;
  const MeshPacket::Mask together =
    this->Kernel.SetRays(visitor.Packet, instance, rays, wanted, alone);
  if (together != 0)
  {
    this->Kernel.FindBricks(visitor.Packet, together, mesh.Bricks, visitor);
  }
  for (MeshPacket::Mask left = visitor.Found; left != 0; left &= left - 1)
  {
    const int index = GetLowest(left);
    hits[index].Set(
      instance, rays[index], visitor.Packet.Nearest[index].Hit, visitor.Attributes[index]);
  }
  for (; alone != 0; alone &= alone - 1)
  {
    const int index = GetLowest(alone);
    const bool found = this->Intersect(instance, rays[index], hits[index]);
    visitor.Found |= MeshPacket::Mask{ found } << index;
  }
  return visitor.Found;
}

/// Searches the bricks that a packet meets for any hit.
template <class Store>
class MeshTracer<Store>::OcclusionVisitor final : public MeshKernel::Visitor
{
public:
  OcclusionVisitor(const MeshTracer& tracer, const TriangleMesh& mesh)
    : Tracer(tracer)
    , Mesh(mesh)
  {
  }

  void Visit(std::uint32_t number, MeshPacket::Mask rays) override
  {
    const typename Store::Pin pin =
      this->Tracer.Blocks.Acquire(this->Tracer.Self, *this->Mesh.Segment, number);
    this->Found |=
      this->Tracer.Kernel.FindOccluded(this->Packet, rays, TriangleBrick(pin.GetData()));
  }

  MeshPacket Packet;
  MeshPacket::Mask Found = 0;

private:
  const MeshTracer& Tracer;
  const TriangleMesh& Mesh;
};

template <class Store>
MeshPacket::Mask MeshTracer<Store>::FindOccluded(
  const MeshInstance& instance, const Ray* rays, MeshPacket::Mask wanted) const
{
  const TriangleMesh& mesh = instance.GetMesh();
  if (mesh.Bricks.IsEmpty())
  {
    return 0;
  }
  OcclusionVisitor visitor(*this, mesh);
  MeshPacket::Mask alone = 0;
  const MeshPacket::Mask together =
    this->Kernel.SetRays(visitor.Packet, instance, rays, wanted, alone);
  if (together != 0)
  {
    this->Kernel.FindBricks(visitor.Packet, together, mesh.Bricks, visitor);
  }
  for (; alone != 0; alone &= alone - 1)
  {
    const int index = GetLowest(alone);
    visitor.Found |= MeshPacket::Mask{ this->IsOccluded(instance, rays[index]) } << index;
  }
  return visitor.Found;
}

} // namespace rt

#endif
