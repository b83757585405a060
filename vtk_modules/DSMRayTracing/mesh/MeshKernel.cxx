// SPDX-License-Identifier: BSD-3-Clause

#include "DSMRayTracing/base/VectorTargets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "DSMRayTracing/mesh/MeshKernel.cxx"
#include <hwy/foreach_target.h> // IWYU pragma: keep

#include "DSMRayTracing/mesh/MeshKernel.h"

#include "DSMRayTracing/base/VectorKernel.h"
#include "DSMRayTracing/mesh/MeshPacketSetup-inl.h"
#include "DSMRayTracing/mesh/MeshPacketWalk-inl.h"

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// The functions of MeshKernel with vectors of D.
template <class D>
class MeshSteps
{
public:
  using Mask = MeshPacket::Mask;

  static MeshKernel Create(const char* name)
  {
    return { name, MeshPacketWalk<D>::Width, &SetRays, &FindBricks, &SearchBrick, &FindOccluded };
  }

private:
  static Mask SetRays(
    MeshPacket& packet, const MeshInstance& instance, const Ray* rays, Mask wanted, Mask& alone)
  {
    alone = 0;
    if (wanted == 0)
    {
      return 0;
    }
    packet.Culling = instance.Culling;
    return MeshPacketSetup<D>(packet, instance, rays, wanted).Set(alone);
  }

  static void FindBricks(const MeshPacket& packet, Mask rays, const bricks::BrickBvh& bricks,
    MeshKernel::Visitor& visitor)
  {
    MeshPacketWalk<D>(packet).Traverse(
      bricks.GetNodes(), rays, [](std::uint32_t) {},
      [&](std::uint32_t leaf, Mask met) { visitor.Visit(bricks::BrickBvh::GetBrick(leaf), met); });
  }

  static Mask SearchBrick(
    MeshPacket& packet, Mask rays, const bricks::TriangleBrick& brick, std::uint32_t number)
  {
    return Search(packet, rays, brick, NearestSearch(packet, brick, number));
  }

  static Mask FindOccluded(MeshPacket& packet, Mask rays, const bricks::TriangleBrick& brick)
  {
    return Search(packet, rays, brick, AnySearch(packet, brick));
  }

  /// Keeps the nearest hit of each ray.
  class NearestSearch
  {
  public:
    NearestSearch(MeshPacket& packet, const bricks::TriangleBrick& brick, std::uint32_t number)
      : Packet(packet)
      , Brick(brick)
      , Number(number)
    {
    }

    /// Returns whether the triangle is the ray's nearest hit so far.
    HWY_INLINE bool Try(int index, std::uint32_t triangle)
    {
      NearestTriangle& nearest = this->Packet.Nearest[index];
      const bool better = nearest.Try(this->Packet.GetTriangleRay(index), this->Packet.Culling,
        this->Brick, this->Number, triangle);
      if (better)
      {
        this->Packet.Shorten(index, nearest.Hit.T);
      }
      return better;
    }
    static constexpr bool EndsAtHit = false;

  private:
    MeshPacket& Packet;
    const bricks::TriangleBrick& Brick;
    std::uint32_t Number;
  };

  /// Ends each ray that hits anything.
  class AnySearch
  {
  public:
    AnySearch(MeshPacket& packet, const bricks::TriangleBrick& brick)
      : Packet(packet)
      , Brick(brick)
    {
    }

    HWY_INLINE bool Try(int index, std::uint32_t triangle)
    {
      TriangleHit hit;
      const bool meets = NearestTriangle::Meets(
        this->Packet.GetTriangleRay(index), this->Packet.Culling, this->Brick, triangle, hit);
      if (meets)
      {
        this->Packet.End(index);
      }
      return meets;
    }
    static constexpr bool EndsAtHit = true;

  private:
    MeshPacket& Packet;
    const bricks::TriangleBrick& Brick;
  };

  template <class Rule>
  static Mask Search(MeshPacket& packet, Mask rays, const bricks::TriangleBrick& brick, Rule rule)
  {
    for (Mask left = rays; left != 0; left &= left - 1)
    {
      packet.SetFilter(GetLowest(left), brick);
    }
    switch (packet.Axes[2])
    {
      case 0:
        return SearchAlong<0>(packet, rays, brick, rule);
      case 1:
        return SearchAlong<1>(packet, rays, brick, rule);
      default:
        return SearchAlong<2>(packet, rays, brick, rule);
    }
  }

  template <int Axis, class Rule>
  static Mask SearchAlong(
    MeshPacket& packet, Mask rays, const bricks::TriangleBrick& brick, Rule& rule)
  {
    using Walk = MeshPacketWalk<D>;
    LeafSearch<Axis, Rule> search(packet, brick, rule);
    Walk(packet).Traverse(
      brick.GetNodes(), rays,
      [&](std::uint16_t leaf)
      { Walk::Fetch(brick.GetTriangle(bricks::TriangleBrick::Leaf(leaf).First), 1); },
      [&](std::uint16_t leaf, Mask met) { search.Search(bricks::TriangleBrick::Leaf(leaf), met); });
    return search.GetFound();
  }

  /// Tries the triangles of leaves.
  template <int Axis, class Rule>
  class LeafSearch
  {
  public:
    LeafSearch(const MeshPacket& packet, const bricks::TriangleBrick& brick, Rule& rule)
      : Packet(packet)
      , Brick(brick)
      , Hits(rule)
    {
    }

    HWY_INLINE void Search(const bricks::TriangleBrick::Leaf& leaf, Mask rays)
    {
      const TriangleFilter<Axis> filter(this->Brick, leaf.First);
      for (; rays != 0; rays &= rays - 1)
      {
        const int index = GetLowest(rays);
        unsigned candidates = filter.FindCandidates(this->Packet.Filters[index]) & leaf.GetMask();
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
    }

    /// Rays that have found something.
    Mask GetFound() const { return this->Found; }

  private:
    const MeshPacket& Packet;
    const bricks::TriangleBrick& Brick;
    Rule& Hits;
    Mask Found = 0;
  };
};

RT_CREATE_KERNEL(MeshKernel, MeshSteps, float, MeshPacket::Size)

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rt
{

RT_DISPATCH_KERNEL(MeshKernel)

} // namespace rt
#endif
