// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see MeshKernel.cxx.
#if defined(rt_MeshPacketSetup_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MeshPacketSetup_inl_h
#undef rt_MeshPacketSetup_inl_h
#else
#define rt_MeshPacketSetup_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/mesh/MeshPacket.h"

#include <hwy/highway.h>

#include <cmath>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// MeshInstance::GetMeshRay for the rays of a packet: the same operations in the same order. A ray for which that
/// returns false is left out here, and so is one with a number that is not finite, since it hits nothing. FloatTag:
/// vectors of floats; doubles have as many lanes as fit.
template <class FloatTag>
class MeshPacketSetup
{
public:
  using Mask = MeshPacket::Mask;
  using Tag = hn::CappedTag<double, (hn::MaxLanes(FloatTag()) + 1) / 2>;
  using Vector = hn::Vec<Tag>;
  using Lanes = hn::Mask<Tag>;
  static constexpr int Size = MeshPacket::Size;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(Tag()));

  /// `wanted` is not empty.
  MeshPacketSetup(MeshPacket& packet, const MeshInstance& instance, const Ray* rays, Mask wanted)
    : Packet(packet)
    , Instance(instance)
    , Wanted(wanted)
  {
    // Lanes without a ray do what another does, and are never looked at.
    const int any = GetLowest(wanted);
    for (int index = 0; index < Size; ++index)
    {
      if (GetBlock(wanted, index - index % Block) == 0)
      {
        index += Block - 1;
        continue;
      }
      const Ray& ray = rays[(wanted >> index & 1) != 0 ? index : any];
      for (int axis = 0; axis < 3; ++axis)
      {
        this->Origin[axis][index] = ray.Origin[axis];
        this->Direction[axis][index] = ray.Direction[axis];
      }
      packet.Min[index] = ray.Min;
      packet.Max[index] = ray.Max;
    }
  }

  /// Returns the rays that may meet the mesh.
  Mask Set()
  {
    Mask meeting = 0;
    ForEachVector(this->Wanted, [&](int first) { meeting |= this->Clip(first) << first; });
    meeting &= this->Wanted;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Packet.Along[axis] = 0;
      this->Packet.Backward[axis] = 0;
    }
    ForEachVector(meeting, [&](int first) { this->Complete(first); });
    return meeting;
  }

private:
  static constexpr int Block = MeshPacket::Block;

  /// The rays of a block. All of its lanes are set, or none.
  static Mask GetBlock(Mask rays, int first) { return rays >> first & ((Mask{ 1 } << Block) - 1); }

  /// Calls `visit(first)` for the vectors of blocks with any of `rays`.
  template <class Visit>
  static HWY_INLINE void ForEachVector(Mask rays, const Visit& visit)
  {
    for (int block = 0; block < Size; block += Block)
    {
      if (GetBlock(rays, block) != 0)
      {
        for (int first = block; first < block + Block; first += Width)
        {
          visit(first);
        }
      }
    }
  }
  static Mask GetBits(Lanes lanes) { return static_cast<Mask>(GetMaskBits(Tag(), lanes)); }

  static void StoreFloats(Vector value, float* to)
  {
    const hn::Rebind<float, Tag> floats;
    hn::StoreU(hn::DemoteTo(floats, value), floats, to);
  }

  /// A row of the matrix times a vector, in the order of glm's.
  Vector Turn(int row, const Vector vector[3]) const
  {
    const Tag tag;
    const glm::dmat3& matrix = this->Instance.GetWorldToBricks();
    const Vector x = hn::Mul(hn::Set(tag, matrix[0][row]), vector[0]);
    const Vector y = hn::Mul(hn::Set(tag, matrix[1][row]), vector[1]);
    const Vector z = hn::Mul(hn::Set(tag, matrix[2][row]), vector[2]);
    return hn::Add(hn::Add(x, y), z);
  }

  /// Brings rays to the mesh's space; returns those that meet its bounds, and where is stored.
  Mask Clip(int first)
  {
    const Tag tag;
    const Vector zero = hn::Zero(tag);
    const bricks::TriangleMesh& mesh = this->Instance.GetMesh();
    Vector worldOrigin[3];
    Vector worldDirection[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      worldOrigin[axis] = hn::Sub(hn::Load(tag, this->Origin[axis] + first),
        hn::Set(tag, this->Instance.GetWorldOrigin()[axis]));
      worldDirection[axis] = hn::Load(tag, this->Direction[axis] + first);
    }
    Vector origin[3];
    Vector direction[3];
    Vector longest = zero;
    Vector distance = zero;
    Vector sum = zero;
    double extent = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      origin[axis] = this->Turn(axis, worldOrigin);
      direction[axis] = this->Turn(axis, worldDirection);
      hn::Store(origin[axis], tag, this->Origin[axis] + first);
      hn::Store(direction[axis], tag, this->Direction[axis] + first);
      const Vector far = hn::Abs(origin[axis]);
      longest = hn::Max(longest, hn::Abs(direction[axis]));
      distance = hn::Max(distance, hn::Add(far, hn::Set(tag, std::abs(mesh.Lower[axis]))));
      sum = hn::Add(sum, hn::Add(far, hn::Abs(direction[axis])));
      extent = std::fmax(extent, mesh.Upper[axis] - mesh.Lower[axis]);
    }
    Lanes meets = hn::And(hn::Lt(sum, hn::Set(tag, HUGE_VAL)), hn::Gt(longest, zero));
    const Vector margin = hn::Add(hn::Add(hn::Set(tag, extent * ShearedRay::ExtentPart),
                                    hn::Mul(distance, hn::Set(tag, ShearedRay::DistancePart))),
      hn::Set(tag, ShearedRay::SmallestMargin));
    const Vector slope = hn::Mul(longest, hn::Set(tag, ShearedRay::SmallestSlope));
    Vector enter = hn::Load(tag, this->Packet.Min + first);
    Vector leave = hn::Load(tag, this->Packet.Max + first);
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector low = hn::Sub(hn::Sub(hn::Set(tag, mesh.Lower[axis]), margin), origin[axis]);
      const Vector high = hn::Sub(hn::Add(hn::Set(tag, mesh.Upper[axis]), margin), origin[axis]);
      const Vector inverse = hn::Div(hn::Set(tag, 1.0), direction[axis]);
      hn::Store(inverse, tag, this->Inverse[axis] + first);
      const Lanes parallel = hn::Le(hn::Abs(direction[axis]), slope);
      const Lanes outside = hn::Or(hn::Gt(low, zero), hn::Lt(high, zero));
      meets = hn::AndNot(hn::And(parallel, outside), meets);
      const Vector lowT = hn::Mul(low, inverse);
      const Vector highT = hn::Mul(high, inverse);
      enter = hn::IfThenElse(parallel, enter, hn::Max(enter, hn::Min(lowT, highT)));
      leave = hn::IfThenElse(parallel, leave, hn::Min(leave, hn::Max(lowT, highT)));
    }
    hn::Store(enter, tag, this->Packet.StartT + first);
    hn::Store(leave, tag, this->Leave + first);
    hn::Store(longest, tag, this->Packet.BoxesPerT + first);
    hn::Store(margin, tag, this->BoxMargin + first);
    return GetBits(hn::And(meets, hn::Le(enter, leave)));
  }

  /// Sets the rest of the packet's numbers.
  void Complete(int first)
  {
    const Tag tag;
    MeshPacket& packet = this->Packet;
    const Vector enter = hn::Load(tag, packet.StartT + first);
    const Vector longest = hn::Load(tag, packet.BoxesPerT + first);
    const Vector margin = hn::Load(tag, this->BoxMargin + first);
    Vector origin[3];
    Vector direction[3];
    Vector inverse[3];
    Lanes backward[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      origin[axis] = hn::Load(tag, this->Origin[axis] + first);
      direction[axis] = hn::Load(tag, this->Direction[axis] + first);
      inverse[axis] = hn::Load(tag, this->Inverse[axis] + first);
      backward[axis] = hn::Lt(inverse[axis], hn::Zero(tag));
      packet.Backward[axis] |= GetBits(backward[axis]) << first;
      StoreFloats(
        hn::Add(origin[axis], hn::Mul(enter, direction[axis])), packet.Start[axis] + first);
      const Vector unit = hn::Mul(inverse[axis], longest);
      const Vector size = hn::Min(hn::Abs(unit), hn::Set(tag, BoxRay::LargestInverse));
      StoreFloats(hn::CopySign(size, unit), packet.Inverse[axis] + first);
      StoreFloats(hn::Mul(margin, size), packet.Margin[axis] + first);
    }
    // Among axes along which a ray moves equally far, the first one is taken.
    const Lanes isSecond = hn::Gt(hn::Abs(direction[1]), hn::Abs(direction[0]));
    const Lanes isThird =
      hn::Gt(hn::Abs(direction[2]), hn::Max(hn::Abs(direction[0]), hn::Abs(direction[1])));
    const Mask second = GetBits(isSecond);
    const Mask third = GetBits(isThird);
    constexpr Mask all = (Mask{ 1 } << Width) - 1;
    packet.Along[0] |= (all & ~second & ~third) << first;
    packet.Along[1] |= (second & ~third) << first;
    packet.Along[2] |= third << first;
    // The values of the axis that is `next` after the largest one.
    const auto choose = [&](const Vector values[3], int next)
    {
      return hn::IfThenElse(isThird, values[(2 + next) % 3],
        hn::IfThenElse(isSecond, values[(1 + next) % 3], values[next]));
    };
    const Vector scale = choose(inverse, 0);
    const Lanes turns = hn::Lt(scale, hn::Zero(tag));
    const Vector shearX = hn::Mul(choose(direction, 1), scale);
    const Vector shearY = hn::Mul(choose(direction, 2), scale);
    StoreFloats(shearX, packet.FilterShear[0] + first);
    StoreFloats(shearY, packet.FilterShear[1] + first);
    const Vector originX = choose(origin, 1);
    const Vector originY = choose(origin, 2);
    hn::Store(hn::IfThenElse(turns, originY, originX), tag, packet.Origin[0] + first);
    hn::Store(hn::IfThenElse(turns, originX, originY), tag, packet.Origin[1] + first);
    hn::Store(choose(origin, 0), tag, packet.Origin[2] + first);
    hn::Store(hn::IfThenElse(turns, shearY, shearX), tag, packet.Shear[0] + first);
    hn::Store(hn::IfThenElse(turns, shearX, shearY), tag, packet.Shear[1] + first);
    hn::Store(scale, tag, packet.Shear[2] + first);
    StoreFloats(margin, packet.Uncertainty + first);
    const Vector place = hn::Mul(hn::Sub(hn::Load(tag, this->Leave + first), enter), longest);
    const Vector room = hn::Mul(hn::Abs(place), hn::Set(tag, ShearedRay::PlacePart));
    StoreFloats(hn::Add(hn::Add(place, room), margin), packet.BoxesEnd + first);
  }

  MeshPacket& Packet;
  const MeshInstance& Instance;
  Mask Wanted;
  // In world space at first, then in the mesh's space.
  HWY_ALIGN double Origin[3][Size];
  HWY_ALIGN double Direction[3][Size];
  HWY_ALIGN double Inverse[3][Size];
  HWY_ALIGN double Leave[Size];
  HWY_ALIGN double BoxMargin[Size];
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
