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

  void Visit(std::uint32_t number, MeshPacket::Mask rays) override
  {
    const typename Store::Pin pin =
      this->Search.Blocks.Acquire(this->Search.Self, *this->Mesh.Segment, number);
    const bricks::TriangleBrick brick(pin.GetData());
    MeshPacket::Mask better = this->Search.Kernel.SearchBrick(this->Packet, rays, brick, number);
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
  const MeshSearch& Search;
  const bricks::TriangleMesh& Mesh;
};

template <class Store>
template <class Search>
RayMask MeshSearch<Store>::SearchPackets(const Ray* rays, RayMask wanted, const Search& search)
{
  RayMask found = 0;
  for (int first = 0; first < MaxRays; first += MeshPacket::Size)
  {
    const MeshPacket::Mask some = GetPart(wanted, first, MeshPacket::Size);
    if (some != 0)
    {
      found |= RayMask{ search(rays + first, some, first) } << first;
    }
  }
  return found;
}

template <class Store>
template <class Take>
RayMask MeshSearch<Store>::Intersect(
  const MeshInstance& instance, const Ray* rays, RayMask wanted, const Take& take) const
{
  return SearchPackets(rays, wanted,
    [&](const Ray* packet, MeshPacket::Mask some, int first)
    {
      return this->IntersectPacket(
        instance, packet, some, [&](int index, const MeshHit& hit) { take(first + index, hit); });
    });
}

template <class Store>
template <class Visitor>
MeshPacket::Mask MeshSearch<Store>::VisitBricks(
  const MeshInstance& instance, const Ray* rays, MeshPacket::Mask wanted, Visitor& visitor) const
{
  const bricks::TriangleMesh& mesh = instance.GetMesh();
  if (mesh.Bricks.IsEmpty())
  {
    return 0;
  }
  MeshPacket::Mask alone = 0;
  const MeshPacket::Mask together =
    this->Kernel.SetRays(visitor.Packet, instance, rays, wanted, alone);
  if (together != 0)
  {
    this->Kernel.FindBricks(visitor.Packet, together, mesh.Bricks, visitor);
  }
  return alone;
}

template <class Store>
template <class Take>
MeshPacket::Mask MeshSearch<Store>::IntersectPacket(
  const MeshInstance& instance, const Ray* rays, MeshPacket::Mask wanted, const Take& take) const
{
  MeshPacket::Mask alone = wanted;
  MeshPacket::Mask found = 0;
  if (GetCount(wanted) > 1)
  {
    PacketVisitor visitor(*this, instance.GetMesh());
    alone = this->VisitBricks(instance, rays, wanted, visitor);
    found = visitor.Found;
    ForEachRay(found,
      [&](int index)
      {
        MeshHit hit;
        hit.Set(
          instance, rays[index], visitor.Packet.Nearest[index].Hit, visitor.Attributes[index]);
        take(index, hit);
      });
  }
  ForEachRay(alone,
    [&](int index)
    {
      MeshHit hit;
      if (this->Intersect(instance, rays[index], hit))
      {
        take(index, hit);
        found |= MeshPacket::Mask{ 1 } << index;
      }
    });
  return found;
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

  void Visit(std::uint32_t number, MeshPacket::Mask rays) override
  {
    const typename Store::Pin pin =
      this->Search.Blocks.Acquire(this->Search.Self, *this->Mesh.Segment, number);
    this->Found |=
      this->Search.Kernel.FindOccluded(this->Packet, rays, bricks::TriangleBrick(pin.GetData()));
  }

  MeshPacket Packet;
  MeshPacket::Mask Found = 0;

private:
  const MeshSearch& Search;
  const bricks::TriangleMesh& Mesh;
};

template <class Store>
RayMask MeshSearch<Store>::FindOccluded(
  const MeshInstance& instance, const Ray* rays, RayMask wanted) const
{
  return SearchPackets(rays, wanted,
    [&](const Ray* packet, MeshPacket::Mask some, int)
    { return this->FindOccludedInPacket(instance, packet, some); });
}

template <class Store>
MeshPacket::Mask MeshSearch<Store>::FindOccludedInPacket(
  const MeshInstance& instance, const Ray* rays, MeshPacket::Mask wanted) const
{
  MeshPacket::Mask alone = wanted;
  MeshPacket::Mask found = 0;
  if (GetCount(wanted) > 1)
  {
    OcclusionVisitor visitor(*this, instance.GetMesh());
    alone = this->VisitBricks(instance, rays, wanted, visitor);
    found = visitor.Found;
  }
  return found |
    static_cast<MeshPacket::Mask>(
      FindRays(alone, [&](int index) { return this->IsOccluded(instance, rays[index]); }));
}

} // namespace rt

#endif
