// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_BoxRay_h
#define rt_BoxRay_h

#include "DSMBricks/accel/WideBvhNode.h"
#include "DSMBricks/base/Float4.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace rt
{

/// A ray as boxes are tested against it: in floats, from a point at the mesh's bounds, in units in
/// which the direction's longest component is 1. The test never misses a box that the exact ray
/// touches: all planes are moved outward by what rounding can amount to (compare Ize, JCGT 2013). So
/// boxes only save work, and what a ray hits does not depend on them.
struct BoxRay
{
  // The fourth lanes are zero.
  float Origin[4];
  float Inverse[4];
  /// How far the planes are moved, in units of t.
  float Margin[4];
  /// Offsets in bytes, in WideBvhNode::Bounds, of the planes that the ray meets first, and last.
  std::size_t Near[3];
  std::size_t Far[3];

  static constexpr double LargestInverse = 1e9;

  /// `inverse` are the reciprocals of the direction, infinite where it has no component; `margin` is
  /// in units of the mesh. A direction almost along a plane is turned away from it by less than the
  /// margin.
  void Set(const double origin[3], const double inverse[3], double margin)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double size = std::min(std::abs(inverse[axis]), LargestInverse);
      this->Origin[axis] = static_cast<float>(origin[axis]);
      this->Inverse[axis] = static_cast<float>(std::copysign(size, inverse[axis]));
      this->Margin[axis] = static_cast<float>(margin * size);
      const std::size_t lower = bricks::WideBvhWidth * axis;
      const std::size_t upper = bricks::WideBvhWidth * (3 + axis);
      this->Near[axis] = inverse[axis] < 0.0 ? upper : lower;
      this->Far[axis] = inverse[axis] < 0.0 ? lower : upper;
    }
    this->Origin[3] = 0.0f;
    this->Inverse[3] = 0.0f;
    this->Margin[3] = 0.0f;
  }

  /// Bit i set when the ray meets child i within [0, last]; `enter` tells where, at the latest.
  template <class Reference>
  unsigned FindChildren(
    const bricks::WideBvhNode<Reference>& node, float last, float enter[bricks::WideBvhWidth]) const
  {
    // The node's origin and what follows it, with nothing in the fourth lane but what is ignored.
    const bricks::Float4 inverse = bricks::Float4::Load(this->Inverse);
    const bricks::Float4 margin = bricks::Float4::Load(this->Margin);
    const bricks::Float4 start =
      (bricks::Float4::Load(node.Origin) - bricks::Float4::Load(this->Origin)) * inverse;
    const bricks::Float4 step = bricks::Float4::LoadExponents(node.Exponent) * inverse;
    const bricks::Float4 nearStart = start - margin;
    const bricks::Float4 farStart = start + margin;
    bricks::Float4 first[2] = { bricks::Float4::Fill(0.0f), bricks::Float4::Fill(0.0f) };
    bricks::Float4 second[2] = { bricks::Float4::Fill(last), bricks::Float4::Fill(last) };
    this->Clip<0>(node, step, nearStart, farStart, first, second);
    this->Clip<1>(node, step, nearStart, farStart, first, second);
    this->Clip<2>(node, step, nearStart, farStart, first, second);
    first[0].Store(enter);
    first[1].Store(enter + 4);
    const unsigned met = GetLessEqual(first[0], second[0]) | GetLessEqual(first[1], second[1]) << 4;
    return met & ((1u << node.Children) - 1u);
  }

private:
  template <int Axis, class Reference>
  void Clip(const bricks::WideBvhNode<Reference>& node, bricks::Float4 steps,
    bricks::Float4 nearStarts, bricks::Float4 farStarts, bricks::Float4 first[2],
    bricks::Float4 second[2]) const
  {
    const bricks::Float4 step = steps.Spread<Axis>();
    const bricks::Float4 nearStart = nearStarts.Spread<Axis>();
    const bricks::Float4 farStart = farStarts.Spread<Axis>();
    bricks::Float4 near[2];
    bricks::Float4 far[2];
    bricks::Float4::LoadBytes(node.Bounds + this->Near[Axis], near[0], near[1]);
    bricks::Float4::LoadBytes(node.Bounds + this->Far[Axis], far[0], far[1]);
    for (int half = 0; half < 2; ++half)
    {
      first[half] = Max(near[half] * step + nearStart, first[half]);
      second[half] = Min(far[half] * step + farStart, second[half]);
    }
  }
};

} // namespace rt

#endif
