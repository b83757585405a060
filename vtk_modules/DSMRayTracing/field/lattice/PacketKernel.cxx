// SPDX-License-Identifier: BSD-3-Clause

#include "DSMRayTracing/base/VectorTargets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "DSMRayTracing/field/lattice/PacketKernel.cxx"
#include <hwy/foreach_target.h> // IWYU pragma: keep

#include "DSMRayTracing/field/lattice/PacketKernel.h"

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/VectorKernel.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/cells/ExtremumCells-inl.h"
#include "DSMRayTracing/field/cells/SurfaceCells-inl.h"
#include "DSMRayTracing/field/lattice/BrickMarch-inl.h"
#include "DSMRayTracing/field/lattice/BrickSearch-inl.h"
#include "DSMRayTracing/field/lattice/MacrocellComparison-inl.h"
#include "DSMRayTracing/field/lattice/NodePath-inl.h"
#include "DSMRayTracing/field/lattice/NodePlanes-inl.h"
#include "DSMRayTracing/field/lattice/Roughness-inl.h"
#include "DSMRayTracing/field/lattice/VoxelCrossing-inl.h"

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

  static PacketKernel Create(const char* name)
  {
    return { name, Width, &SetRays, &MeetBrick, &SearchBrick, &FindOccluded, &CountCrossings,
      &March, &FindExtrema,
      CreateMacrocellKernel<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t,
        std::uint32_t, std::int64_t, std::uint64_t, float, double>() };
  }

private:
  using First = FirstCrossings<D, VoxelCrossing<D>::PlaceNumbers>;

  template <class... Types>
  static MacrocellKernel CreateMacrocellKernel()
  {
    // Samples are narrower than the packet's numbers, so vectors have room for more of them.
    constexpr std::size_t samples = Width == 1 ? 1 : 8;
    return { &Roughness<Width>::Find, { MacrocellComparisonSteps<Types, samples>::Create()... } };
  }

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
      Mask fits = GetBitMask(tag, wanted >> first);
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
    typename First::Found found;
    First first(&found);
    Search(packet, rays, brick, origin, first);
    Refine(found, hits);
  }

  static RayPacket::Mask FindOccluded(
    const RayPacket& packet, RayPacket::Mask rays, const PacketBrick& brick, const double origin[3])
  {
    First first(nullptr);
    return Search(packet, rays, brick, origin, first);
  }

  static void CountCrossings(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], int* counts)
  {
    CrossingCounts<D> counted(counts);
    Search(packet, rays, brick, origin, counted);
  }

  static RayPacket::Mask March(const RayPacket& packet, RayPacket::Mask rays, MediumBrick& brick,
    const double origin[3], const TransferFunction& function, MediumLight& light)
  {
    using Floats = hn::CappedTag<float, Width == 1 ? 1 : 16>;
    return packet.Planes
      ? BrickMarch<Floats, true>(packet, brick, origin, function, light).March(rays)
      : BrickMarch<Floats, false>(packet, brick, origin, function, light).March(rays);
  }

  static RayPacket::Mask FindExtrema(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], RayExtrema& extrema)
  {
    ExtremumCells<D> cells(extrema);
    return Search(packet, rays, brick, origin, cells);
  }

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

  /// Finds the exact intersections of rays with the surface.
  static void Refine(const typename First::Found& found, PacketHits& hits)
  {
    const D tag;
    hits.Count = found.Count;
    hits.FromInside = 0;
    std::copy_n(found.Ray, found.Count, hits.Ray);
    found.Refine(tag,
      [&](int first, Vector t, Vector position, std::uint32_t isFromInside)
      {
        hn::Store(t, tag, hits.T + first);
        hits.FromInside |= RayPacket::Mask{ isFromInside } << first;
        VoxelCrossing<D>::SetPlace(
          hits, first, position, [&](int number) { return found.GetPlace(tag, number, first); });
      });
  }
};

RT_CREATE_KERNEL(PacketKernel, PacketSteps, double, 8)

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rt
{

RT_DISPATCH_KERNEL(PacketKernel)

} // namespace rt
#endif
