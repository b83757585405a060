// SPDX-License-Identifier: BSD-3-Clause
#ifndef bricks_WideBvhNode_h
#define bricks_WideBvhNode_h

#include <cstdint>

namespace bricks
{

/// Children of a node, at most.
constexpr int WideBvhWidth = 8;

/// A node of a bounding volume hierarchy with up to eight children, whose boxes are kept with eight
/// bits a plane in the node's own grid (after Ylitie et al., HPG 2017): the planes of a child lie at
/// Origin + Bounds * 2^Exponent. Boxes are rounded outward, never inward.
///
/// `Reference` is an unsigned integer. Its highest bit set marks a leaf; a triangle brick's leaf
/// then has its number of triangles less one in the next two bits, and below that the first of them;
/// the leaf of the hierarchy over bricks the number of the brick. Else it is the number of the
/// child's node.
template <class Reference>
struct WideBvhNode
{
  using ReferenceType = Reference;
  static constexpr int Width = WideBvhWidth;
  static constexpr Reference LeafBit =
    static_cast<Reference>(Reference(1) << (8 * sizeof(Reference) - 1));

  float Origin[3];
  /// Scale of the grid on each axis, a power of two: the exponent of a float, biased as there.
  std::uint8_t Exponent[3];
  std::uint8_t Children;
  /// Lower planes, then upper ones; by axis, then child.
  std::uint8_t Bounds[2 * 3 * Width];
  Reference References[Width];
};

static_assert(sizeof(WideBvhNode<std::uint16_t>) == 80, "no padding");
static_assert(sizeof(WideBvhNode<std::uint32_t>) == 96, "no padding");

} // namespace bricks

#endif
