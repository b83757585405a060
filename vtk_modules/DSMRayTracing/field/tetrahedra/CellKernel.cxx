// SPDX-License-Identifier: BSD-3-Clause

#include "DSMRayTracing/base/VectorTargets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "DSMRayTracing/field/tetrahedra/CellKernel.cxx"
#include <hwy/foreach_target.h> // IWYU pragma: keep

#include "DSMRayTracing/field/tetrahedra/CellKernel.h"

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/VectorKernel.h"
#include "DSMRayTracing/field/tetrahedra/CellParts-inl.h"
#include "DSMRayTracing/field/tetrahedra/TetrahedronCrossings-inl.h"

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// The functions of CellKernel with vectors of F.
template <class F>
class CellSteps
{
public:
  static CellKernel Create(const char* name)
  {
    return { name, Width, &FindChildren, &FindOpen, &FindCrossings, &Integrate };
  }

private:
  using Vector = hn::Vec<F>;
  using Mask = hn::Mask<F>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(F()));

  static RayMask GetBits(Mask mask) { return GetMaskBits(F(), mask); }

  /// BoxRay::FindChildren.
  static void FindChildren(const CellPacket& packet, RayMask lanes, const CellKernel::Boxes& boxes,
    unsigned wanted, CellKernel::Children& met)
  {
    const F tag;
    Vector nearest[bricks::WideBvhWidth];
    float scale[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::uint32_t bits = std::uint32_t{ boxes.Exponent[axis] } << 23;
      std::memcpy(&scale[axis], &bits, sizeof(bits));
    }
    for (int child = 0; child < bricks::WideBvhWidth; ++child)
    {
      met.Lanes[child] = 0;
      nearest[child] = hn::Set(tag, std::numeric_limits<float>::infinity());
    }
    for (int first = 0; first < packet.Count; first += Width)
    {
      const std::uint32_t here = GetPart(lanes, first, Width);
      if (here == 0)
      {
        continue;
      }
      const Mask rays = GetBitMask(tag, here);
      Vector step[3];
      Vector nearStart[3];
      Vector farStart[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        const Vector inverse = hn::Load(tag, packet.Inverse[axis] + first);
        const Vector margin = hn::Load(tag, packet.Margin[axis] + first);
        const Vector start = hn::Mul(
          hn::Sub(hn::Set(tag, boxes.Origin[axis]), hn::Load(tag, packet.Start[axis] + first)),
          inverse);
        step[axis] = hn::Mul(hn::Set(tag, scale[axis]), inverse);
        nearStart[axis] = hn::Sub(start, margin);
        farStart[axis] = hn::Add(start, margin);
      }
      const Vector last = hn::Load(tag, packet.BoxesEnd + first);
      for (unsigned left = wanted; left != 0; left &= left - 1)
      {
        const int child = __builtin_ctz(left);
        Vector enter = hn::Zero(tag);
        Vector leave = last;
        for (int axis = 0; axis < 3; ++axis)
        {
          const std::uint8_t* const bounds = boxes.Bounds + bricks::WideBvhWidth * axis + child;
          const Vector lower = hn::Mul(hn::Set(tag, bounds[0]), step[axis]);
          const Vector upper = hn::Mul(hn::Set(tag, bounds[3 * bricks::WideBvhWidth]), step[axis]);
          enter = hn::Max(enter, hn::Add(hn::Min(lower, upper), nearStart[axis]));
          leave = hn::Min(leave, hn::Add(hn::Max(lower, upper), farStart[axis]));
        }
        const Mask meets = hn::And(hn::Le(enter, leave), rays);
        nearest[child] = hn::IfThenElse(meets, hn::Min(nearest[child], enter), nearest[child]);
        met.Lanes[child] |= GetBits(meets) << first;
      }
    }
    for (unsigned left = wanted; left != 0; left &= left - 1)
    {
      const int child = __builtin_ctz(left);
      met.Enter[child] = hn::GetLane(hn::MinOfLanes(tag, nearest[child]));
    }
  }

  static RayMask FindOpen(const CellPacket& packet, RayMask lanes, float enter)
  {
    const F tag;
    RayMask open = 0;
    for (int first = 0; first < packet.Count; first += Width)
    {
      open |= GetBits(hn::Le(hn::Set(tag, enter), hn::Load(tag, packet.BoxesEnd + first))) << first;
    }
    return open & lanes;
  }

  static int FindCrossings(const CellPacket& packet, RayMask lanes, const CellKernel::Group& group,
    CellKernel::Crossing* crossings)
  {
    return Crossings(packet, group).Find(lanes, crossings);
  }

  static RayMask Integrate(const CellPacket& packet, const CellKernel::Runs& runs,
    const TransferFunction& function, MediumLight& light)
  {
    return CellParts<Doubles>(packet, runs, function, light).Integrate();
  }

  using Doubles = hn::CappedTag<double, (hn::MaxLanes(F()) + 1) / 2>;
  using Crossings = TetrahedronCrossings<Doubles>;
};

RT_CREATE_KERNEL(CellKernel, CellSteps, float, 16)

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rt
{

RT_DISPATCH_KERNEL(CellKernel)

} // namespace rt
#endif
