// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see MeshKernel.cxx.
#if defined(rt_MeshPacketWalk_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MeshPacketWalk_inl_h
#undef rt_MeshPacketWalk_inl_h
#else
#define rt_MeshPacketWalk_inl_h
#endif

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/mesh/MeshPacket.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// TraverseWideBvh for a packet: a node is visited once for all rays that meet its box before they end. D: vectors
/// of rays. A walk of its own: functions for an instruction set cannot be inlined into that template, which is
/// compiled for every processor.
template <class D>
class MeshPacketWalk
{
public:
  using Vector = hn::Vec<D>;
  using Mask = MeshPacket::Mask;
  static constexpr int Size = MeshPacket::Size;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  explicit MeshPacketWalk(const MeshPacket& packet)
    : Packet(packet)
  {
  }

  /// Calls `visit(reference, rays)` for leaves, about front to back; it may lower packet.BoxesEnd; before,
  /// and ahead of time, `prepare(reference)`.
  template <class Reference, class Prepare, class Visit>
  HWY_INLINE void Traverse(
    const bricks::WideBvhNode<Reference>* nodes, Mask rays, Prepare&& prepare, Visit&& visit) const
  {
    using Node = bricks::WideBvhNode<Reference>;
    HWY_ALIGN float enters[LargestWideBvhStack][Size];
    struct Entry
    {
      Reference Child;
      Mask Rays;
    };
    Entry stack[LargestWideBvhStack];
    int size = 0;
    Reference child = 0;
    while (true)
    {
      if (child & Node::LeafBit)
      {
        visit(child, rays);
      }
      else
      {
        const Node& node = nodes[child];
        Children met;
        this->FindChildren(node, rays, met);
        // The nearest child goes to the top, by where its first ray enters it.
        const int bottom = size;
        for (int slot = 0; slot < node.Children; ++slot)
        {
          if (met.Rays[slot] == 0)
          {
            continue;
          }
          const Reference reference = node.References[slot];
          if (reference & Node::LeafBit)
          {
            prepare(reference);
          }
          else
          {
            Fetch(&nodes[reference], sizeof(Node));
          }
          const int lane = GetLowest(met.Rays[slot]);
          const float enter = met.Enter[slot][lane];
          int place = size++;
          for (; place > bottom && enters[place - 1][GetLowest(stack[place - 1].Rays)] < enter;
               --place)
          {
            Copy(enters[place - 1], enters[place]);
            stack[place] = stack[place - 1];
          }
          Copy(met.Enter[slot], enters[place]);
          stack[place] = { reference, met.Rays[slot] };
        }
      }
      do
      {
        if (size == 0)
        {
          return;
        }
        --size;
        rays = this->FindOpen(enters[size], stack[size].Rays);
      } while (rays == 0);
      child = stack[size].Child;
    }
  }

  /// Asks for memory that will be read soon.
  static HWY_INLINE void Fetch(const void* start, std::size_t bytes)
  {
    constexpr std::size_t line = 64;
    const auto* const first = static_cast<const char*>(start);
    for (const char* at = first; at < first + bytes; at += line)
    {
      hwy::Prefetch(at);
    }
  }

private:
  struct Children
  {
    HWY_ALIGN float Enter[bricks::WideBvhWidth][Size];
    Mask Rays[bricks::WideBvhWidth];
  };

  static Mask GetBits(hn::Mask<D> mask) { return static_cast<Mask>(GetMaskBits(D(), mask)); }
  static constexpr Mask GetLanes(int first) { return ((Mask{ 1 } << Width) - 1) << first; }

  static HWY_INLINE void Copy(const float* from, float* to)
  {
    for (int first = 0; first < Size; first += Width)
    {
      hn::Store(hn::Load(D(), from + first), D(), to + first);
    }
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

  /// BoxRay::FindChildren.
  template <class Reference>
  HWY_INLINE void FindChildren(
    const bricks::WideBvhNode<Reference>& node, Mask rays, Children& met) const
  {
    const D tag;
    float planes[6 * bricks::WideBvhWidth];
    for (int plane = 0; plane < 6 * bricks::WideBvhWidth; ++plane)
    {
      planes[plane] = node.Bounds[plane];
    }
    float scale[3];
    const float* nearest[3];
    const float* farthest[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::uint32_t bits = std::uint32_t{ node.Exponent[axis] } << 23;
      std::memcpy(&scale[axis], &bits, sizeof(bits));
      nearest[axis] =
        planes + bricks::WideBvhWidth * (this->Packet.Backward[axis] ? 3 + axis : axis);
      farthest[axis] =
        planes + bricks::WideBvhWidth * (this->Packet.Backward[axis] ? axis : 3 + axis);
    }
    for (Mask& child : met.Rays)
    {
      child = 0;
    }
    for (int first = 0; first < Size; first += Width)
    {
      if ((rays & GetLanes(first)) == 0)
      {
        continue;
      }
      Vector step[3];
      Vector nearStart[3];
      Vector farStart[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        const Vector inverse = hn::Load(tag, this->Packet.Inverse[axis] + first);
        const Vector margin = hn::Load(tag, this->Packet.Margin[axis] + first);
        const Vector start = hn::Mul(
          hn::Sub(hn::Set(tag, node.Origin[axis]), hn::Load(tag, this->Packet.Start[axis] + first)),
          inverse);
        step[axis] = hn::Mul(hn::Set(tag, scale[axis]), inverse);
        nearStart[axis] = hn::Sub(start, margin);
        farStart[axis] = hn::Add(start, margin);
      }
      const Vector last = hn::Load(tag, this->Packet.BoxesEnd + first);
      for (int child = 0; child < node.Children; ++child)
      {
        Vector enter = hn::Zero(tag);
        Vector leave = last;
        for (int axis = 0; axis < 3; ++axis)
        {
          enter = hn::Max(
            hn::MulAdd(hn::Set(tag, nearest[axis][child]), step[axis], nearStart[axis]), enter);
          leave = hn::Min(
            hn::MulAdd(hn::Set(tag, farthest[axis][child]), step[axis], farStart[axis]), leave);
        }
        hn::Store(enter, tag, met.Enter[child] + first);
        met.Rays[child] |= GetBits(hn::Le(enter, leave)) << first & rays;
      }
    }
  }

  const MeshPacket& Packet;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
