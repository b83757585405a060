// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see MeshKernel.cxx.
#if defined(rt_MeshPacketWalk_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MeshPacketWalk_inl_h
#undef rt_MeshPacketWalk_inl_h
#else
#define rt_MeshPacketWalk_inl_h
#endif

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/base/PrefetchLine.h"
#include "DSMRayTracing/mesh/MeshPacketBoxes-inl.h"
#include "DSMRayTracing/ray/WideBvhTraversal.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// TraverseWideBvh for a packet. D: vectors of rays. A node is visited once for all rays that meet its box before they
/// end, as long as these are many. Few rays each continue alone, with the children of a node in a vector. They take
/// steps in turn, so that the memory that one of them asks for arrives while the others are at work. A walk of its own:
/// functions for an instruction set cannot be inlined into that template, which is compiled for every processor.
template <class D>
class MeshPacketWalk
{
public:
  using Mask = MeshPacket::Mask;
  static constexpr int Size = MeshPacket::Size;

  explicit MeshPacketWalk(const MeshPacket& packet)
    : Packet(packet)
    , Boxes(packet)
  {
  }

  /// Takes `rays` through a hierarchy, up to `Few` of them alone. `search` has
  /// - void Visit(leaf, rays): leaves are visited about front to back; it may lower packet.BoxesEnd;
  /// - void Fetch(leaf): asks for memory that the visit will need, ahead of time;
  /// - void FetchMore(leaf): asks for more of it, later, ahead of a visit of one ray.
  /// The last two must be inlined; see PrefetchLine.
  template <int Few, class Reference, class Search>
  HWY_INLINE void Traverse(
    const bricks::WideBvhNode<Reference>* nodes, Mask rays, Search& search) const
  {
    using Node = bricks::WideBvhNode<Reference>;
    Stack<Reference> stack;
    stack.Push(0, rays);
    LoneRays<Reference> lone;
    while (stack.Count > 0)
    {
      if (Few > 0 && stack.GetTopCount() <= Few)
      {
        stack.template MoveTo<Few>(lone);
        while (lone.Rays != 0)
        {
          for (Mask left = lone.Rays; left != 0; left &= left - 1)
          {
            this->Step(nodes, GetLowest(left), lone, search);
          }
        }
        continue;
      }
      --stack.Count;
      const Reference child = stack.Entries[stack.Count].Child;
      rays = this->Boxes.FindOpen(stack.Enters[stack.Count], stack.Entries[stack.Count].Rays);
      if (rays == 0)
      {
        continue;
      }
      if (child & Node::LeafBit)
      {
        search.Visit(child, rays);
        continue;
      }
      const Node& node = nodes[child];
      typename MeshPacketBoxes<D>::Children met;
      this->Boxes.FindChildren(node, rays, met);
      const int bottom = stack.Count;
      for (int slot = 0; slot < node.Children; ++slot)
      {
        if (met.Rays[slot] != 0)
        {
          Fetch(nodes, node.References[slot], search);
          stack.Insert(bottom, node.References[slot], met.Rays[slot], met.Enter[slot]);
        }
      }
    }
  }

private:
  /// The children that wait for a ray that continues alone: the nearest is on top.
  template <class Reference>
  struct LoneRays
  {
    struct Entry
    {
      float Enter;
      Reference Child;
    };
    Entry Entries[Size][LargestWideBvhStack];
    int Count[Size] = {};
    Mask Rays = 0; ///< for which any wait
    /// Leaves that were taken off the stack, and are visited in the ray's next turn; those that have one.
    Entry Leaf[Size];
    Mask HaveLeaf = 0;
  };

  /// The children that wait for several rays, and where these enter them; the nearest is on top.
  template <class Reference>
  struct Stack
  {
    struct Entry
    {
      Reference Child;
      Mask Rays;
    };
    HWY_ALIGN float Enters[LargestWideBvhStack][Size];
    Entry Entries[LargestWideBvhStack];
    int Count = 0;

    int GetTopCount() const { return GetCount(this->Entries[this->Count - 1].Rays); }

    /// Adds a child that rays enter at once.
    HWY_INLINE void Push(Reference child, Mask rays)
    {
      std::fill_n(this->Enters[this->Count], Size, 0.0f);
      this->Entries[this->Count++] = { child, rays };
    }

    /// Adds a child above `bottom`, by where its first ray enters it.
    HWY_INLINE void Insert(int bottom, Reference child, Mask rays, const float* enter)
    {
      const float first = enter[GetLowest(rays)];
      int place = this->Count++;
      for (; place > bottom &&
           this->Enters[place - 1][GetLowest(this->Entries[place - 1].Rays)] < first;
           --place)
      {
        Copy(this->Enters[place - 1], this->Enters[place]);
        this->Entries[place] = this->Entries[place - 1];
      }
      Copy(enter, this->Enters[place]);
      this->Entries[place] = { child, rays };
    }

    /// Moves the children on top that `Few` rays or fewer meet.
    template <int Few>
    HWY_INLINE void MoveTo(LoneRays<Reference>& lone)
    {
      const int end = this->Count;
      while (this->Count > 0 && this->GetTopCount() <= Few)
      {
        --this->Count;
      }
      for (int place = this->Count; place < end; ++place)
      {
        const Entry& entry = this->Entries[place];
        lone.Rays |= entry.Rays;
        for (Mask left = entry.Rays; left != 0; left &= left - 1)
        {
          const int index = GetLowest(left);
          lone.Entries[index][lone.Count[index]++] = { this->Enters[place][index], entry.Child };
        }
      }
    }

  private:
    static HWY_INLINE void Copy(const float* from, float* to)
    {
      for (int first = 0; first < Size; first += static_cast<int>(hn::MaxLanes(D())))
      {
        hn::Store(hn::Load(D(), from + first), D(), to + first);
      }
    }
  };

  /// Asks for a child, which will be read soon.
  template <class Reference, class Search>
  static HWY_INLINE void Fetch(
    const bricks::WideBvhNode<Reference>* nodes, Reference child, const Search& search)
  {
    if (child & bricks::WideBvhNode<Reference>::LeafBit)
    {
      search.Fetch(child);
      return;
    }
    constexpr std::size_t line = 64;
    const auto* const first = reinterpret_cast<const char*>(&nodes[child]);
    for (std::size_t at = 0; at < sizeof(nodes[child]); at += line)
    {
      bricks::PrefetchLine(first + at);
    }
  }

  /// Takes a turn of a ray that continues alone.
  template <class Reference, class Search>
  HWY_INLINE void Step(const bricks::WideBvhNode<Reference>* nodes, int index,
    LoneRays<Reference>& lone, Search& search) const
  {
    using Node = bricks::WideBvhNode<Reference>;
    const Mask bit = GetBit(index);
    if ((lone.HaveLeaf & bit) != 0)
    {
      lone.HaveLeaf &= ~bit;
      if (lone.Leaf[index].Enter <= this->Packet.BoxesEnd[index])
      {
        search.Visit(lone.Leaf[index].Child, bit);
      }
    }
    auto* const entries = lone.Entries[index];
    int& count = lone.Count[index];
    const float end = this->Packet.BoxesEnd[index];
    while (count > 0 && !(entries[count - 1].Enter <= end))
    {
      --count;
    }
    if (count == 0)
    {
      lone.Rays &= ~bit;
      return;
    }
    const auto next = entries[--count];
    if (next.Child & Node::LeafBit)
    {
      search.FetchMore(next.Child);
      lone.Leaf[index] = next;
      lone.HaveLeaf |= bit;
      return;
    }
    const Node& node = nodes[next.Child];
    HWY_ALIGN float enter[bricks::WideBvhWidth];
    const int bottom = count;
    int size = count;
    for (unsigned met = this->Boxes.FindChildrenOfOne(node, index, enter); met != 0; met &= met - 1)
    {
      const int slot = GetLowest(met);
      Fetch(nodes, node.References[slot], search);
      int place = size++;
      for (; place > bottom && entries[place - 1].Enter < enter[slot]; --place)
      {
        entries[place] = entries[place - 1];
      }
      entries[place] = { enter[slot], node.References[slot] };
    }
    count = size;
  }

  const MeshPacket& Packet;
  MeshPacketBoxes<D> Boxes;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
