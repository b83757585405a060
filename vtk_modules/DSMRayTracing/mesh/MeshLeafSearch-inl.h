// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see MeshKernel.cxx.
#if defined(rt_MeshLeafSearch_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MeshLeafSearch_inl_h
#undef rt_MeshLeafSearch_inl_h
#else
#define rt_MeshLeafSearch_inl_h
#endif

#include "DSMBricks/base/PrefetchLine.h"
#include "DSMBricks/layout/TriangleBrick.h"
#include "DSMRayTracing/mesh/MeshPacketTriangle-inl.h"
#include "DSMRayTracing/mesh/TriangleFilter.h"

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Keeps the nearest hit of each ray.
class MeshNearestHits
{
public:
  MeshNearestHits(MeshPacket& packet, const bricks::TriangleBrick& brick, std::uint32_t number)
    : Packet(packet)
    , Brick(brick)
    , Number(number)
  {
  }

  /// Returns whether the triangle is the ray's nearest hit so far.
  HWY_INLINE bool Try(int index, std::uint32_t triangle)
  {
    return this->End(index,
      this->Packet.Nearest[index].Try(this->Packet.GetTriangleRay(index), this->Packet.Culling,
        this->Brick, this->Number, triangle));
  }
  HWY_INLINE bool Take(int index, std::uint32_t triangle, TriangleHit& hit)
  {
    hit.Brick = this->Number;
    hit.Triangle = triangle;
    return this->End(index, this->Packet.Nearest[index].Take(hit));
  }
  static constexpr bool EndsAtHit = false;

private:
  HWY_INLINE bool End(int index, bool better)
  {
    if (better)
    {
      this->Packet.Shorten(index, this->Packet.Nearest[index].Hit.T);
    }
    return better;
  }

  MeshPacket& Packet;
  const bricks::TriangleBrick& Brick;
  std::uint32_t Number;
};

/// Ends each ray that hits anything.
class MeshAnyHits
{
public:
  MeshAnyHits(MeshPacket& packet, const bricks::TriangleBrick& brick)
    : Packet(packet)
    , Brick(brick)
  {
  }

  HWY_INLINE bool Try(int index, std::uint32_t triangle)
  {
    TriangleHit hit;
    return NearestTriangle::Meets(this->Packet.GetTriangleRay(index), this->Packet.Culling,
             this->Brick, triangle, hit) &&
      this->Take(index, triangle, hit);
  }
  HWY_INLINE bool Take(int index, std::uint32_t, const TriangleHit&)
  {
    this->Packet.End(index);
    return true;
  }
  static constexpr bool EndsAtHit = true;

private:
  MeshPacket& Packet;
  const bricks::TriangleBrick& Brick;
};

/// Tries the triangles of leaves with rays of a packet, in vectors D. Rule: MeshNearestHits or MeshAnyHits.
template <class D, class Rule>
class MeshLeafSearch
{
public:
  using Mask = MeshPacket::Mask;

  MeshLeafSearch(const MeshPacket& packet, const bricks::TriangleBrick& brick, Rule& rule)
    : Packet(packet)
    , Brick(brick)
    , Hits(rule)
  {
  }

  HWY_INLINE void Fetch(std::uint16_t reference) const
  {
    bricks::PrefetchLine(this->Brick.GetTriangle(Leaf(reference).First));
  }
  HWY_INLINE void FetchMore(std::uint16_t reference) const
  {
    const bricks::TriangleBrickVertex* vertices = this->Brick.GetVertices();
    const std::uint16_t* corners = this->Brick.GetTriangle(Leaf(reference).First);
    for (int corner = 0; corner < 12; ++corner)
    {
      bricks::PrefetchLine(vertices + corners[corner]);
    }
  }

  HWY_INLINE void Visit(std::uint16_t reference, Mask rays)
  {
    const Leaf leaf(reference);
    if (GetCount(rays) == 1)
    {
      const int index = GetLowest(rays);
      switch (this->Packet.GetAxis(index))
      {
        case 0:
          return this->SearchOne<0>(leaf, index);
        case 1:
          return this->SearchOne<1>(leaf, index);
        default:
          return this->SearchOne<2>(leaf, index);
      }
    }
    this->SearchAlong<0>(leaf, rays);
    this->SearchAlong<1>(leaf, rays);
    this->SearchAlong<2>(leaf, rays);
  }

  /// Rays that have found something.
  Mask GetFound() const { return this->Found; }

private:
  using Leaf = bricks::TriangleBrick::Leaf;

  /// All triangles against one ray.
  template <int Axis>
  void SearchOne(const Leaf& leaf, int index)
  {
    const TriangleFilter<Axis> filter(this->Brick, leaf.First);
    unsigned candidates = filter.FindCandidates(this->Packet.GetFilterRay(index)) & leaf.GetMask();
    for (; candidates != 0; candidates &= candidates - 1)
    {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctz(candidates));
      if (this->Hits.Try(index, leaf.First + lane))
      {
        this->Found |= Mask{ 1 } << index;
        if constexpr (Rule::EndsAtHit)
        {
          break;
        }
      }
    }
  }

  /// One triangle after the other against those of the rays that move most along an axis.
  template <int Axis>
  void SearchAlong(const Leaf& leaf, Mask rays)
  {
    rays &= this->Packet.Along[Axis];
    const bricks::TriangleBrickVertex* vertices = this->Brick.GetVertices();
    const std::uint16_t* corners = this->Brick.GetTriangle(leaf.First);
    for (std::uint32_t number = 0; number < leaf.Count && rays != 0; ++number, corners += 3)
    {
      const std::uint32_t triangle = leaf.First + number;
      const MeshPacketTriangle<D, Axis> one(this->Packet, vertices[corners[0]].Position,
        vertices[corners[1]].Position, vertices[corners[2]].Position);
      Mask candidates = one.FindCandidates(rays);
      Mask found = 0;
      if (this->Brick.GetHeader().Radii || GetCount(candidates) < 2)
      {
        for (; candidates != 0; candidates &= candidates - 1)
        {
          const int index = GetLowest(candidates);
          found |= this->Hits.Try(index, triangle) ? Mask{ 1 } << index : 0;
        }
      }
      else
      {
        one.Intersect(candidates,
          [&](int index, TriangleHit& hit)
          {
            if (!(hit.Front ? this->Packet.Culling.Front : this->Packet.Culling.Back) &&
              this->Hits.Take(index, triangle, hit))
            {
              found |= Mask{ 1 } << index;
            }
          });
      }
      this->Found |= found;
      if constexpr (Rule::EndsAtHit)
      {
        rays &= ~found;
      }
    }
  }

  const MeshPacket& Packet;
  const bricks::TriangleBrick& Brick;
  Rule& Hits;
  Mask Found = 0;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
