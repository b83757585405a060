// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see MeshKernel.cxx.
#if defined(rt_MeshPacketBoxes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MeshPacketBoxes_inl_h
#undef rt_MeshPacketBoxes_inl_h
#else
#define rt_MeshPacketBoxes_inl_h
#endif

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/mesh/MeshPacket.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// BoxRay for the rays of a packet. D: vectors of rays.
template <class D>
class MeshPacketBoxes
{
public:
  using Vector = hn::Vec<D>;
  using Mask = MeshPacket::Mask;
  static constexpr int Size = MeshPacket::Size;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  /// The rays that meet each child of a node, and where they enter it.
  struct Children
  {
    HWY_ALIGN float Enter[bricks::WideBvhWidth][Size];
    Mask Rays[bricks::WideBvhWidth];
  };

  explicit MeshPacketBoxes(const MeshPacket& packet)
    : Packet(packet)
  {
  }

  /// Returns the subset of `rays` that have not ended where they enter.
  HWY_INLINE Mask FindOpen(const float* enter, Mask rays) const
  {
    const D tag;
    Mask open = 0;
    for (int first = 0; first < Size; first += Width)
    {
      open |=
        GetBits(hn::Le(hn::Load(tag, enter + first), hn::Load(tag, this->Packet.BoxesEnd + first)))
        << first;
    }
    return open & rays;
  }

  /// Tests a vector of rays after the other with all children.
  template <class Reference>
  HWY_INLINE void FindChildren(
    const bricks::WideBvhNode<Reference>& node, Mask rays, Children& met) const
  {
    float planes[6 * bricks::WideBvhWidth];
    for (int plane = 0; plane < 6 * bricks::WideBvhWidth; ++plane)
    {
      planes[plane] = node.Bounds[plane];
    }
    for (Mask& child : met.Rays)
    {
      child = 0;
    }
    for (int first = 0; first < Size; first += Width)
    {
      const Mask some = rays & GetLanes(first);
      if (some == 0)
      {
        continue;
      }
      const auto isMixed = [&](int axis)
      {
        const Mask backward = this->Packet.Backward[axis] & some;
        return backward != 0 && backward != some;
      };
      if (isMixed(0) || isMixed(1) || isMixed(2))
      {
        this->FindChildrenOfSome<true>(node, planes, first, some, met);
      }
      else
      {
        this->FindChildrenOfSome<false>(node, planes, first, some, met);
      }
    }
  }

  /// Tests one ray with a vector of children. Bit i of the result is child i.
  template <class Reference>
  HWY_INLINE unsigned FindChildrenOfOne(
    const bricks::WideBvhNode<Reference>& node, int index, float* enters) const
  {
    using ChildVector = hn::Vec<ChildTag>;
    const ChildTag tag;
    const hn::Rebind<std::int32_t, ChildTag> whole;
    const hn::Rebind<std::uint8_t, ChildTag> bytes;
    ChildVector step[3];
    ChildVector nearStart[3];
    ChildVector farStart[3];
    const std::uint8_t* nearest[3];
    const std::uint8_t* farthest[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const float inverse = this->Packet.Inverse[axis][index];
      const float margin = this->Packet.Margin[axis][index];
      const float start = (node.Origin[axis] - this->Packet.Start[axis][index]) * inverse;
      step[axis] = hn::Set(tag, GetScale(node, axis) * inverse);
      nearStart[axis] = hn::Set(tag, start - margin);
      farStart[axis] = hn::Set(tag, start + margin);
      const bool backward = this->Packet.IsBackward(index, axis);
      nearest[axis] = node.Bounds + bricks::WideBvhWidth * (backward ? 3 + axis : axis);
      farthest[axis] = node.Bounds + bricks::WideBvhWidth * (backward ? axis : 3 + axis);
    }
    unsigned met = 0;
    for (int first = 0; first < bricks::WideBvhWidth; first += ChildLanes)
    {
      const auto load = [&](const std::uint8_t* planes)
      { return hn::ConvertTo(tag, hn::PromoteTo(whole, hn::LoadU(bytes, planes + first))); };
      ChildVector enter = hn::Zero(tag);
      ChildVector leave = hn::Set(tag, this->Packet.BoxesEnd[index]);
      for (int axis = 0; axis < 3; ++axis)
      {
        enter = hn::Max(hn::MulAdd(load(nearest[axis]), step[axis], nearStart[axis]), enter);
        leave = hn::Min(hn::MulAdd(load(farthest[axis]), step[axis], farStart[axis]), leave);
      }
      hn::Store(enter, tag, enters + first);
      met |= GetMaskBits(tag, hn::Le(enter, leave)) << first;
    }
    return met & ((1u << node.Children) - 1u);
  }

private:
  static constexpr int ChildLanes = std::min(Width, bricks::WideBvhWidth);
  using ChildTag = hn::CappedTag<float, ChildLanes>;

  static Mask GetBits(hn::Mask<D> mask) { return static_cast<Mask>(GetMaskBits(D(), mask)); }
  static constexpr Mask GetLanes(int first) { return ((Mask{ 1 } << Width) - 1) << first; }

  template <class Reference>
  static HWY_INLINE float GetScale(const bricks::WideBvhNode<Reference>& node, int axis)
  {
    const std::uint32_t bits = std::uint32_t{ node.Exponent[axis] } << 23;
    float scale;
    std::memcpy(&scale, &bits, sizeof(bits));
    return scale;
  }

  /// Tests the children with a vector of rays, of which `some` count. Mixed: they differ in direction on an axis.
  template <bool Mixed, class Reference>
  HWY_INLINE void FindChildrenOfSome(const bricks::WideBvhNode<Reference>& node,
    const float* planes, int first, Mask some, Children& met) const
  {
    const D tag;
    Vector step[3];
    Vector nearStart[3];
    Vector farStart[3];
    hn::Mask<D> backward[3];
    const float* nearest[3];
    const float* farthest[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector inverse = hn::Load(tag, this->Packet.Inverse[axis] + first);
      const Vector margin = hn::Load(tag, this->Packet.Margin[axis] + first);
      const Vector start = hn::Mul(
        hn::Sub(hn::Set(tag, node.Origin[axis]), hn::Load(tag, this->Packet.Start[axis] + first)),
        inverse);
      step[axis] = hn::Mul(hn::Set(tag, GetScale(node, axis)), inverse);
      nearStart[axis] = hn::Sub(start, margin);
      farStart[axis] = hn::Add(start, margin);
      backward[axis] = hn::Lt(inverse, hn::Zero(tag));
      const bool exchanges = !Mixed && (this->Packet.Backward[axis] & some) != 0;
      nearest[axis] = planes + bricks::WideBvhWidth * (exchanges ? 3 + axis : axis);
      farthest[axis] = planes + bricks::WideBvhWidth * (exchanges ? axis : 3 + axis);
    }
    const Vector last = hn::Load(tag, this->Packet.BoxesEnd + first);
    for (int child = 0; child < node.Children; ++child)
    {
      Vector enter = hn::Zero(tag);
      Vector leave = last;
      for (int axis = 0; axis < 3; ++axis)
      {
        Vector near = hn::Set(tag, nearest[axis][child]);
        Vector far = hn::Set(tag, farthest[axis][child]);
        if constexpr (Mixed)
        {
          const Vector lower = near;
          near = hn::IfThenElse(backward[axis], far, lower);
          far = hn::IfThenElse(backward[axis], lower, far);
        }
        enter = hn::Max(hn::MulAdd(near, step[axis], nearStart[axis]), enter);
        leave = hn::Min(hn::MulAdd(far, step[axis], farStart[axis]), leave);
      }
      hn::Store(enter, tag, met.Enter[child] + first);
      met.Rays[child] |= GetBits(hn::Le(enter, leave)) << first & some;
    }
  }

  const MeshPacket& Packet;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
