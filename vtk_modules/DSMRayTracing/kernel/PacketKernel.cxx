// SPDX-License-Identifier: BSD-3-Clause

#include "DSMRayTracing/kernel/VectorTargets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "DSMRayTracing/kernel/PacketKernel.cxx"
#include <hwy/foreach_target.h> // IWYU pragma: keep

#include "DSMRayTracing/kernel/PacketKernel.h"

#include "DSMRayTracing/brick/VoxelBrickHeader.h"
#include "DSMRayTracing/kernel/MacrocellComparison-inl.h"
#include "DSMRayTracing/kernel/MaskBits-inl.h"
#include "DSMRayTracing/kernel/PacketWalk-inl.h"

#include <hwy/highway.h>

#include <cmath>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// The functions of PacketKernel with vectors of D.
template <class D>
class PacketSteps
{
public:
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));
  static constexpr int Vectors = RayPacket::Size / Width;

  static RayPacket::Mask SetRays(RayPacket& packet, const Ray* rays, RayPacket::Mask wanted,
    const IndexSpace& space, const Index3& cells)
  {
    const D tag;
    const WorldRays world(rays, wanted);
    const glm::dmat3& matrix = space.GetWorldToIndex();
    const Vector infinity = hn::Set(tag, HUGE_VAL);
    RayPacket::Mask fitting = 0;
    RayPacket::Mask crossing = 0;
    for (int first = 0; first < RayPacket::Size; first += Width)
    {
      Vector origin[3];
      Vector direction[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        origin[axis] =
          hn::Sub(hn::Load(tag, world.Origin[axis] + first), hn::Set(tag, space.GetOrigin()[axis]));
        direction[axis] = hn::Load(tag, world.Direction[axis] + first);
      }
      Vector enter = hn::Load(tag, world.Min + first);
      Vector leave = hn::Load(tag, world.Max + first);
      Mask fits = GetMask(wanted, first);
      for (int axis = 0; axis < 3; ++axis)
      {
        const Vector start = Multiply(matrix, axis, origin);
        const Vector way = Multiply(matrix, axis, direction);
        const Vector inverse = hn::Div(hn::Set(tag, 1.0), way);
        const bool forward = packet.Forward[axis];
        const Vector ahead = forward ? way : hn::Neg(way);
        fits = hn::And(hn::And(fits, hn::Gt(ahead, hn::Zero(tag))),
          hn::And(
            hn::Lt(hn::Abs(hn::Add(start, way)), infinity), hn::Lt(hn::Abs(inverse), infinity)));
        hn::Store(start, tag, packet.Origin[axis] + first);
        hn::Store(way, tag, packet.Direction[axis] + first);
        hn::Store(inverse, tag, packet.Inverse[axis] + first);
        const auto end = static_cast<double>(cells[axis]);
        enter = hn::Max(enter, GetPlaneT(packet, first, axis, forward ? 0.0 : end));
        leave = hn::Min(leave, GetPlaneT(packet, first, axis, forward ? end : 0.0));
      }
      hn::Store(enter, tag, packet.Enter + first);
      hn::Store(leave, tag, packet.Leave + first);
      fitting |= GetBits(fits) << first;
      crossing |= GetBits(hn::And(fits, hn::Lt(enter, leave))) << first;
    }
    packet.Rays = crossing;
    return wanted & ~fitting;
  }

  static RayPacket::Mask MeetBox(const RayPacket& packet, RayPacket::Mask rays,
    const double lower[3], const double upper[3], double* enter, double* leave)
  {
    const D tag;
    RayPacket::Mask met = 0;
    for (int first = 0; first < RayPacket::Size; first += Width)
    {
      Vector in = hn::Load(tag, packet.Enter + first);
      Vector out = hn::Load(tag, packet.Leave + first);
      for (int axis = 0; axis < 3; ++axis)
      {
        const bool forward = packet.Forward[axis];
        in = hn::Max(in, GetPlaneT(packet, first, axis, forward ? lower[axis] : upper[axis]));
        out = hn::Min(out, GetPlaneT(packet, first, axis, forward ? upper[axis] : lower[axis]));
      }
      hn::Store(in, tag, enter + first);
      hn::Store(out, tag, leave + first);
      met |= GetBits(hn::Lt(in, out)) << first;
    }
    return met & rays;
  }

  static RayPacket::Mask SearchBrick(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], const double* enter, const double* leave,
    PacketHits& hits)
  {
    PacketCrossings crossings;
    const RayPacket::Mask found =
      SearchParts(packet, rays, brick, origin, enter, leave, &crossings);
    Refine(crossings, found, hits);
    return found;
  }

  static RayPacket::Mask FindOccluded(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], const double* enter, const double* leave)
  {
    return SearchParts(packet, rays, brick, origin, enter, leave, nullptr);
  }

private:
  /// Those of `rays` that meet the surface in a brick; how is stored where `crossings` is not null.
  static HWY_INLINE RayPacket::Mask SearchParts(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], const double* enter, const double* leave,
    PacketCrossings* crossings)
  {
    int parts[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      parts[axis] = (brick.GetMacrocells(axis) + 3) / 4;
    }
    RayPacket::Mask found = 0;
    for (int k = 0; k < parts[2] && found != rays; ++k)
    {
      for (int j = 0; j < parts[1] && found != rays; ++j)
      {
        for (int i = 0; i < parts[0] && found != rays; ++i)
        {
          // In the order in which they are met.
          const int part[3] = { packet.Forward[0] ? i : parts[0] - 1 - i,
            packet.Forward[1] ? j : parts[1] - 1 - j, packet.Forward[2] ? k : parts[2] - 1 - k };
          found |= SearchPart(packet, rays & ~found, brick, origin, enter, leave, part,
            /*whole=*/parts[0] * parts[1] * parts[2] == 1, crossings);
        }
      }
    }
    return found;
  }

  /// Rays as vectors want them. Those that are not wanted are copies of one that is.
  struct WorldRays
  {
    HWY_ALIGN double Origin[3][RayPacket::Size];
    HWY_ALIGN double Direction[3][RayPacket::Size];
    HWY_ALIGN double Min[RayPacket::Size];
    HWY_ALIGN double Max[RayPacket::Size];

    WorldRays(const Ray* rays, RayPacket::Mask wanted)
    {
      const int any = wanted != 0 ? GetLowest(wanted) : 0;
      for (int index = 0; index < RayPacket::Size; ++index)
      {
        const Ray& ray = rays[(wanted >> index & 1) != 0 ? index : any];
        for (int axis = 0; axis < 3; ++axis)
        {
          this->Origin[axis][index] = ray.Origin[axis];
          this->Direction[axis][index] = ray.Direction[axis];
        }
        this->Min[index] = ray.Min;
        this->Max[index] = ray.Max;
      }
    }
  };

  /// A row of a matrix times a vector, in the order of glm's.
  static Vector Multiply(const glm::dmat3& matrix, int row, const Vector vector[3])
  {
    const D tag;
    const Vector x = hn::Mul(hn::Set(tag, matrix[0][row]), vector[0]);
    const Vector y = hn::Mul(hn::Set(tag, matrix[1][row]), vector[1]);
    const Vector z = hn::Mul(hn::Set(tag, matrix[2][row]), vector[2]);
    return hn::Add(hn::Add(x, y), z);
  }

  static RayPacket::Mask GetBits(Mask mask) { return GetMaskBits(D(), mask); }
  static Mask GetMask(RayPacket::Mask rays, int first)
  {
    const std::uint8_t bits[8] = { static_cast<std::uint8_t>(rays >> first) };
    return hn::LoadMaskBits(D(), bits);
  }

  static Vector GetPlaneT(const RayPacket& packet, int first, int axis, double plane)
  {
    const D tag;
    return hn::Mul(hn::Sub(hn::Set(tag, plane), hn::Load(tag, packet.Origin[axis] + first)),
      hn::Load(tag, packet.Inverse[axis] + first));
  }

  /// The 4 x 4 x 4 macrocells of a part of the brick; `whole`: that is all of it.
  static HWY_INLINE RayPacket::Mask SearchPart(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], const double* enter, const double* leave,
    const int part[3], bool whole, PacketCrossings* crossings)
  {
    const PacketPart& macrocells = brick.FindPart(part);
    if (macrocells.Macrocells == 0)
    {
      return 0;
    }
    const D tag;
    constexpr int edge = 4 * MacrocellEdge;
    RayPacket::Mask found = 0;
    for (int first = 0; first < RayPacket::Size; first += Width)
    {
      Mask meet = GetMask(rays, first);
      if (hn::AllFalse(tag, meet))
      {
        continue;
      }
      Vector in = hn::Load(tag, enter + first);
      Vector out = hn::Load(tag, leave + first);
      for (int axis = 0; axis < 3 && !whole; ++axis)
      {
        const bool forward = packet.Forward[axis];
        const double lower = origin[axis] + edge * part[axis];
        in = hn::Max(in, GetPlaneT(packet, first, axis, forward ? lower : lower + edge));
        out = hn::Min(out, GetPlaneT(packet, first, axis, forward ? lower + edge : lower));
      }
      meet = hn::And(meet, hn::Lt(in, out));
      PacketWalk<D> walk(tag, packet, first, brick, origin, crossings);
      found |= GetBits(walk.Search(part, macrocells, meet, in, out)) << first;
    }
    return found;
  }

  /// Where exactly the rays of `found` meet the surface.
  static void Refine(const PacketCrossings& crossings, RayPacket::Mask found, PacketHits& hits)
  {
    const D tag;
    hits.FromInside = 0;
    for (int first = 0; first < RayPacket::Size; first += Width)
    {
      const Mask rays = GetMask(found, first);
      if (hn::AllFalse(tag, rays))
      {
        continue;
      }
      Vector coefficients[4];
      for (int power = 0; power < 4; ++power)
      {
        coefficients[power] = hn::Load(tag, crossings.Coefficients[power] + first);
      }
      const Bracket<D> bracket{ hn::Load(tag, crossings.BeginS + first),
        hn::Load(tag, crossings.BeginValue + first), hn::Load(tag, crossings.EndS + first),
        hn::Load(tag, crossings.EndValue + first) };
      const Vector s = PacketCrossing<D>(tag, coefficients).Refine(rays, bracket);
      const Vector enter = hn::Load(tag, crossings.Enter + first);
      const Vector leave = hn::Load(tag, crossings.Leave + first);
      const Vector t = hn::Add(enter, hn::Mul(s, hn::Sub(leave, enter)));
      hn::Store(hn::IfThenElse(hn::Lt(leave, t), leave, t), tag, hits.T + first);
      // Nothing changes its side before the bracket.
      hits.FromInside |= GetBits(hn::Ge(bracket.BeginValue, hn::Zero(tag))) << first;
      for (int axis = 0; axis < 3; ++axis)
      {
        const Vector start = hn::Load(tag, crossings.Start[axis] + first);
        const Vector way = hn::Load(tag, crossings.Way[axis] + first);
        hn::Store(ClampToUnit(hn::Add(start, hn::Mul(s, way))), tag, hits.Local[axis] + first);
        hn::Store(hn::Load(tag, crossings.Cell[axis] + first), tag, hits.Cell[axis] + first);
      }
    }
  }
};

template <class D>
PacketKernel Create(const char* name, const MacrocellKernel& macrocells)
{
  return { name, PacketSteps<D>::Width, &PacketSteps<D>::SetRays, &PacketSteps<D>::MeetBox,
    &PacketSteps<D>::SearchBrick, &PacketSteps<D>::FindOccluded, macrocells };
}

PacketKernel CreateWide()
{
  return Create<hn::CappedTag<double, 8>>(hwy::TargetName(HWY_TARGET), CreateMacrocellKernel<8>());
}

PacketKernel CreateSingle()
{
  return Create<hn::CappedTag<double, 1>>("one ray at a time", CreateMacrocellKernel<1>());
}

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rt
{

namespace
{

HWY_EXPORT(CreateWide);
HWY_EXPORT(CreateSingle);

} // namespace

const PacketKernel& PacketKernel::GetBest()
{
  static const PacketKernel best = HWY_DYNAMIC_DISPATCH(CreateWide)();
  return best;
}

std::vector<PacketKernel> PacketKernel::GetAll()
{
  return CreateForAllTargets<PacketKernel>(
    { HWY_DYNAMIC_DISPATCH(CreateSingle)() }, [] { return HWY_DYNAMIC_DISPATCH(CreateWide)(); });
}

} // namespace rt
#endif
