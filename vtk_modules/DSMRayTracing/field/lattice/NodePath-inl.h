// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_NodePath_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_NodePath_inl_h
#undef rt_NodePath_inl_h
#else
#define rt_NodePath_inl_h
#endif

#include "DSMRayTracing/ray/RayPacket.h"

#include <hwy/highway.h>

#include <cstdint>

#ifndef rt_NodeWords
#define rt_NodeWords
namespace rt
{

/// Nodes of 4 x 4 x 4 (NodeOrder) that lie before each of the three planes between them, by axis.
constexpr std::uint64_t NodesBefore[3][3] = {
  { 0x1111111111111111u, 0x3333333333333333u, 0x7777777777777777u },
  { 0x000f000f000f000fu, 0x00ff00ff00ff00ffu, 0x0fff0fff0fff0fffu },
  { 0x000000000000ffffu, 0x00000000ffffffffu, 0x0000ffffffffffffu },
};

} // namespace rt
#endif

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Returns the coordinate of the node with that number (NodeOrder).
template <class Numbers>
HWY_INLINE Numbers GetCoordinate(Numbers nodes, int axis)
{
  const hn::DFromV<Numbers> numbers;
  const Numbers shifted = axis == 0 ? nodes
    : axis == 1                     ? hn::ShiftRight<2>(nodes)
                                    : hn::ShiftRight<4>(nodes);
  return hn::And(shifted, hn::Set(numbers, std::uint64_t{ 3 }));
}

/// One vector of rays.
template <class D>
struct RayLines
{
  using Vector = hn::Vec<D>;

  Vector Origin[3];
  Vector Inverse[3];

  RayLines() = default;
  /// Rays `first` and those after it.
  HWY_INLINE RayLines(const RayPacket& packet, int first)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Origin[axis] = hn::Load(D(), packet.Origin[axis] + first);
      this->Inverse[axis] = hn::Load(D(), packet.Inverse[axis] + first);
    }
  }

  HWY_INLINE Vector GetPlaneT(int axis, Vector plane) const
  {
    return hn::Mul(hn::Sub(plane, this->Origin[axis]), this->Inverse[axis]);
  }
};

/// The nodes (NodeOrder) that rays, from `enter` to `leave`, cross of a box of 4 x 4 x 4; each ray may have a box
/// of its own. `getPlane(axis, number)`: the planes of the boxes, from 0, through which rays come in, to 4. They
/// are those that GridWalk steps through: where a ray meets several planes at once, it goes through all of them
/// together. Nodes that a ray only touches may be added.
///
/// A ray is on all three axes between two planes at a time when it is so on each two of them: so every
/// two planes tell, by which of them is met first, that some nodes are never come to.
template <class D, class GetPlane, class Vector = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToUnsigned<D>> FindCrossedNodes(
  const RayLines<D>& lines, const GetPlane& getPlane, Vector enter, Vector leave)
{
  const hn::RebindToUnsigned<D> numbers;
  Vector between[3][3];
  for (int axis = 0; axis < 3; ++axis)
  {
    enter = hn::Max(enter, lines.GetPlaneT(axis, getPlane(axis, 0)));
    leave = hn::Min(leave, lines.GetPlaneT(axis, getPlane(axis, 4)));
#pragma GCC unroll 3
    for (int plane = 0; plane < 3; ++plane)
    {
      between[axis][plane] = lines.GetPlaneT(axis, getPlane(axis, plane + 1));
    }
  }
  auto nodes = hn::Set(numbers, ~std::uint64_t{ 0 });
  const auto keepWhere = [&](auto condition, std::uint64_t kept)
  {
    nodes = hn::IfThenElse(
      hn::RebindMask(numbers, condition), hn::And(nodes, hn::Set(numbers, kept)), nodes);
  };
#pragma GCC unroll 3
  for (int axis = 0; axis < 3; ++axis)
  {
#pragma GCC unroll 3
    for (int plane = 0; plane < 3; ++plane)
    {
      const std::uint64_t before = NodesBefore[axis][plane];
      keepWhere(hn::Le(between[axis][plane], enter), ~before);
      keepWhere(hn::Le(leave, between[axis][plane]), before);
    }
  }
#pragma GCC unroll 3
  for (int pair = 0; pair < 3; ++pair)
  {
    const int one = pair == 2 ? 1 : 0;
    const int other = pair == 0 ? 1 : 2;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i)
    {
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j)
      {
        const std::uint64_t beforeOne = NodesBefore[one][i];
        const std::uint64_t beforeOther = NodesBefore[other][j];
        const auto oneFirst = hn::RebindMask(numbers, hn::Le(between[one][i], between[other][j]));
        nodes = hn::And(nodes,
          hn::IfThenElse(oneFirst, hn::Set(numbers, ~(beforeOne & ~beforeOther)),
            hn::Set(numbers, ~(beforeOther & ~beforeOne))));
      }
    }
  }
  return hn::IfThenElseZero(hn::RebindMask(numbers, hn::Lt(enter, leave)), nodes);
}

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
