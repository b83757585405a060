// SPDX-License-Identifier: BSD-3-Clause

#include "DSMRayTracing/base/VectorTargets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "DSMRayTracing/mesh/MeshKernel.cxx"
#include <hwy/foreach_target.h> // IWYU pragma: keep

#include "DSMRayTracing/mesh/MeshKernel.h"

#include "DSMRayTracing/base/VectorKernel.h"
#include "DSMRayTracing/mesh/MeshLeafSearch-inl.h"
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
  /// So many rays of a node, and fewer, continue alone.
  static constexpr int FewRays = 8;

  static MeshKernel Create(const char* name)
  {
    return { name, static_cast<int>(hn::MaxLanes(D())), &SetRays, &FindBricks, &SearchBrick,
      &FindOccluded };
  }

private:
  static Mask SetRays(
    MeshPacket& packet, const MeshInstance& instance, const Ray* rays, Mask wanted)
  {
    packet.Culling = instance.Culling;
    return wanted == 0 ? 0 : MeshPacketSetup<D>(packet, instance, rays, wanted).Set();
  }

  static void FindBricks(const MeshPacket& packet, Mask rays, const bricks::BrickBvh& bricks,
    MeshKernel::Visitor& visitor)
  {
    BrickVisit visit(visitor);
    MeshPacketWalk<D>(packet).template Traverse<0>(bricks.GetNodes(), rays, visit);
  }

  static Mask SearchBrick(
    MeshPacket& packet, Mask rays, const bricks::TriangleBrick& brick, std::uint32_t number)
  {
    return Search(packet, rays, brick, MeshNearestHits(packet, brick, number));
  }

  static Mask FindOccluded(MeshPacket& packet, Mask rays, const bricks::TriangleBrick& brick)
  {
    return Search(packet, rays, brick, MeshAnyHits(packet, brick));
  }

  template <class Rule>
  static Mask Search(MeshPacket& packet, Mask rays, const bricks::TriangleBrick& brick, Rule rule)
  {
    for (int index = 0; index < MeshPacket::Size; ++index)
    {
      packet.FilterError[index] = FilterRay::GetError(packet.Uncertainty[index], brick);
    }
    MeshLeafSearch<D, Rule> search(packet, brick, rule);
    MeshPacketWalk<D>(packet).template Traverse<FewRays>(brick.GetNodes(), rays, search);
    return search.GetFound();
  }

  /// Visits the bricks that leaves stand for.
  class BrickVisit
  {
  public:
    explicit BrickVisit(MeshKernel::Visitor& visitor)
      : Visitor(visitor)
    {
    }
    HWY_INLINE void Fetch(std::uint32_t) const {}
    HWY_INLINE void FetchMore(std::uint32_t) const {}
    HWY_INLINE void Visit(std::uint32_t leaf, Mask rays)
    {
      this->Visitor.Visit(bricks::BrickBvh::GetBrick(leaf), rays);
    }

  private:
    MeshKernel::Visitor& Visitor;
  };
};

RT_CREATE_KERNEL(MeshKernel, MeshSteps, float, MeshPacket::Block)

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rt
{

RT_DISPATCH_KERNEL(MeshKernel)

} // namespace rt
#endif
