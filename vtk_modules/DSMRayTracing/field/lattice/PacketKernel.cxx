// SPDX-License-Identifier: BSD-3-Clause

#include "DSMRayTracing/base/VectorTargets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "DSMRayTracing/field/lattice/PacketKernel.cxx"
#include <hwy/foreach_target.h> // IWYU pragma: keep

#include "DSMRayTracing/field/lattice/PacketKernel.h"

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/field/lattice/BrickSearch-inl.h"
#include "DSMRayTracing/field/lattice/ExtremumCells-inl.h"
#include "DSMRayTracing/field/lattice/MacrocellComparison-inl.h"
#include "DSMRayTracing/field/lattice/MediumCells-inl.h"
#include "DSMRayTracing/field/lattice/NodePath-inl.h"
#include "DSMRayTracing/field/lattice/NodePlanes-inl.h"
#include "DSMRayTracing/field/lattice/Roughness-inl.h"
#include "DSMRayTracing/field/lattice/SurfaceCells-inl.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
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

  static RayPacket::Mask SetRays(RayPacket& packet, const Ray* rays, RayPacket::Mask wanted,
    const IndexSpace& space, const bricks::Index3& cells)
  {
    const D tag;
    const glm::dmat3& matrix = space.GetWorldToIndex();
    const Vector infinity = hn::Set(tag, HUGE_VAL);
    RayPacket::Mask fitting = 0;
    RayPacket::Mask crossing = 0;
    for (int first = 0; first < RayPacket::Size; first += Width)
    {
      const std::uint32_t lanes = GetPart(wanted, first, Width);
      if (lanes == 0)
      {
        continue;
      }
      // Copies of one that is wanted stand for those that are not.
      const Ray* own[Width];
      for (int lane = 0; lane < Width; ++lane)
      {
        own[lane] = rays + first + ((lanes >> lane & 1) != 0 ? lane : __builtin_ctz(lanes));
      }
      Vector origin[3];
      Vector direction[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        const Vector start =
          SetLanes<double, Width>([&](int lane) { return own[lane]->Origin[axis]; });
        origin[axis] = hn::Sub(start, hn::Set(tag, space.GetOrigin()[axis]));
        direction[axis] =
          SetLanes<double, Width>([&](int lane) { return own[lane]->Direction[axis]; });
      }
      Vector enter = SetLanes<double, Width>([&](int lane) { return own[lane]->Min; });
      Vector leave = SetLanes<double, Width>([&](int lane) { return own[lane]->Max; });
      RayLines<D> lines;
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
        lines.Origin[axis] = start;
        lines.Inverse[axis] = inverse;
        const Vector end = hn::Set(tag, static_cast<double>(cells[axis]));
        enter = hn::Max(enter, lines.GetPlaneT(axis, forward ? hn::Zero(tag) : end));
        leave = hn::Min(leave, lines.GetPlaneT(axis, forward ? end : hn::Zero(tag)));
      }
      hn::Store(enter, tag, packet.Enter + first);
      hn::Store(leave, tag, packet.Leave + first);
      fitting |= RayPacket::Mask{ GetBits(fits) } << first;
      crossing |= RayPacket::Mask{ GetBits(hn::And(fits, hn::Lt(enter, leave))) } << first;
    }
    packet.Planes = space.GetPlanes();
    packet.Rays = crossing;
    return wanted & ~fitting;
  }

  static RayPacket::Mask MeetBrick(
    RayPacket& packet, RayPacket::Mask rays, const double lower[3], const double upper[3])
  {
    const D tag;
    RayPacket::Mask met = 0;
    for (int first = 0; first < RayPacket::Size; first += Width)
    {
      if (GetPart(rays, first, Width) == 0)
      {
        continue;
      }
      const RayLines<D> lines(packet, first);
      Vector enter = hn::Load(tag, packet.Enter + first);
      Vector leave = hn::Load(tag, packet.Leave + first);
      for (int axis = 0; axis < 3; ++axis)
      {
        const bool forward = packet.Forward[axis];
        const auto getPlace = [&](double plane)
        { return hn::Set(tag, packet.Planes ? packet.Planes->GetPlace(axis, plane) : plane); };
        const Vector entry = getPlace(forward ? lower[axis] : upper[axis]);
        const Vector end = getPlace(forward ? upper[axis] : lower[axis]);
        enter = hn::Max(enter, lines.GetPlaneT(axis, entry));
        leave = hn::Min(leave, lines.GetPlaneT(axis, end));
      }
      hn::Store(enter, tag, packet.BrickEnter + first);
      hn::Store(leave, tag, packet.BrickLeave + first);
      met |= RayPacket::Mask{ GetBits(hn::Lt(enter, leave)) } << first;
    }
    return met & rays;
  }

  static void SearchBrick(const RayPacket& packet, RayPacket::Mask rays, const PacketBrick& brick,
    const double origin[3], PacketHits& hits)
  {
    CellCrossings crossings;
    FirstCrossings<D> first(&crossings);
    Search(packet, rays, brick, origin, first);
    Refine(crossings, hits);
  }

  static RayPacket::Mask FindOccluded(
    const RayPacket& packet, RayPacket::Mask rays, const PacketBrick& brick, const double origin[3])
  {
    FirstCrossings<D> first(nullptr);
    return Search(packet, rays, brick, origin, first);
  }

  static void CountCrossings(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], int* counts)
  {
    CrossingCounts<D> counted(counts);
    Search(packet, rays, brick, origin, counted);
  }

  static RayPacket::Mask March(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], const TransferFunction& function,
    MediumLight& light)
  {
    MediumCells<D> cells(function, light);
    return Search(packet, rays, brick, origin, cells);
  }

  static RayPacket::Mask FindExtrema(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], RayExtrema& extrema)
  {
    ExtremumCells<D> cells(extrema);
    return Search(packet, rays, brick, origin, cells);
  }

private:
  template <class Visitor>
  static RayPacket::Mask Search(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], Visitor& visitor)
  {
    return packet.Planes
      ? BrickSearch<D, Visitor, StretchedPlanes<D>>(packet, brick, origin, visitor).Search(rays)
      : BrickSearch<D, Visitor, UniformPlanes<D>>(packet, brick, origin, visitor).Search(rays);
  }

  /// A row of a matrix times a vector, in the order of glm's.
  static Vector Multiply(const glm::dmat3& matrix, int row, const Vector vector[3])
  {
    const D tag;
    const Vector x = hn::Mul(hn::Set(tag, matrix[0][row]), vector[0]);
    const Vector y = hn::Mul(hn::Set(tag, matrix[1][row]), vector[1]);
    const Vector z = hn::Mul(hn::Set(tag, matrix[2][row]), vector[2]);
    return hn::Add(hn::Add(x, y), z);
  }

  static std::uint32_t GetBits(Mask mask) { return GetMaskBits(D(), mask); }
  static Mask GetMask(RayPacket::Mask rays, int first)
  {
    const std::uint8_t bits[8] = { static_cast<std::uint8_t>(rays >> first) };
    return hn::LoadMaskBits(D(), bits);
  }

  /// Finds the exact intersections of rays with the surface.
  static void Refine(const CellCrossings& crossings, PacketHits& hits)
  {
    using Number = CellCrossings::Number;
    const D tag;
    hits.Count = crossings.Count;
    hits.FromInside = 0;
    std::copy_n(crossings.Ray, crossings.Count, hits.Ray);
    for (int first = 0; first < crossings.Count; first += Width)
    {
      const auto load = [&](int number) { return hn::Load(tag, crossings.Values[number] + first); };
      const Mask rays = hn::FirstN(tag, static_cast<std::size_t>(crossings.Count - first));
      Vector coefficients[4];
      for (int power = 0; power < 4; ++power)
      {
        coefficients[power] = load(Number::Coefficients + power);
      }
      const Bracket<D> bracket{ load(Number::BeginS), load(Number::BeginValue), load(Number::EndS),
        load(Number::EndValue) };
      const Vector s = PacketCrossing<D>(tag, coefficients).Refine(rays, bracket);
      const Vector enter = load(Number::Enter);
      const Vector leave = load(Number::Leave);
      const Vector t = hn::Add(enter, hn::Mul(s, hn::Sub(leave, enter)));
      hn::Store(hn::IfThenElse(hn::Lt(leave, t), leave, t), tag, hits.T + first);
      // Nothing changes its side before the bracket.
      hits.FromInside |= RayPacket::Mask{ GetBits(hn::Ge(bracket.BeginValue, hn::Zero(tag))) }
        << first;
      for (int axis = 0; axis < 3; ++axis)
      {
        const Vector start = load(Number::Start + axis);
        const Vector way = load(Number::Way + axis);
        hn::Store(ClampToUnit(hn::Add(start, hn::Mul(s, way))), tag, hits.Local[axis] + first);
        hn::Store(load(Number::Cell + axis), tag, hits.Cell[axis] + first);
      }
    }
  }
};

template <class D>
PacketKernel Create(const char* name, const MacrocellKernel& macrocells)
{
  return { name, PacketSteps<D>::Width, &PacketSteps<D>::SetRays, &PacketSteps<D>::MeetBrick,
    &PacketSteps<D>::SearchBrick, &PacketSteps<D>::FindOccluded, &PacketSteps<D>::CountCrossings,
    &PacketSteps<D>::March, &PacketSteps<D>::FindExtrema, &Roughness<PacketSteps<D>::Width>::Find,
    macrocells };
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
