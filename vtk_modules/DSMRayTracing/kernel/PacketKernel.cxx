// SPDX-License-Identifier: BSD-3-Clause

// Vectors of a size that is only known at run time cannot be members; SSSE3 alone is not worth code
// of its own.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "DSMRayTracing/kernel/PacketKernel.cxx"
#include <hwy/foreach_target.h> // IWYU pragma: keep

#include "DSMRayTracing/kernel/PacketKernel.h"

#include "DSMRayTracing/brick/BrickLattice.h"
#include "DSMRayTracing/brick/VoxelBrickHeader.h"
#include "DSMRayTracing/kernel/PacketWalk-inl.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

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
    NodeBox box = GetNodes(packet, rays, brick, origin, enter, leave);
    PlaneTable planes;
    FillPlanes(packet, origin, box, planes);
    PacketCrossings crossings;
    RayPacket::Mask found = 0;
    for (int k = 0; k < box.Size[2] && found != rays; ++k)
    {
      const int z = packet.Forward[2] ? box.First[2] + k : box.First[2] + box.Size[2] - 1 - k;
      for (int j = 0; j < box.Size[1] && found != rays; ++j)
      {
        const int y = packet.Forward[1] ? box.First[1] + j : box.First[1] + box.Size[1] - 1 - j;
        found |= SearchRow(packet, rays & ~found, brick, origin, enter, leave, box, planes, y, z,
          crossings);
      }
    }
    Refine(crossings, found, hits);
    return found;
  }

private:
  static constexpr int MostMacrocells = BrickLattice::LargestEdge / MacrocellEdge;

  /// Macrocells of a brick.
  struct NodeBox
  {
    int First[3];
    int Size[3];
  };

  /// Where each ray meets the planes between macrocells.
  using PlaneTable = double[3][MostMacrocells + 1][RayPacket::Size];

  static RayPacket::Mask GetBits(Mask mask)
  {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(D(), mask, bits);
    return bits[0];
  }
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

  /// All macrocells that the rays may meet, and few others: only they are looked at.
  static NodeBox GetNodes(const RayPacket& packet, RayPacket::Mask rays, const PacketBrick& brick,
    const double origin[3], const double* enter, const double* leave)
  {
    // In cells; more than the rounding of a point.
    constexpr double margin = 1e-3;
    const D tag;
    const Vector infinity = hn::Set(tag, HUGE_VAL);
    NodeBox box;
    for (int axis = 0; axis < 3; ++axis)
    {
      Vector low = infinity;
      Vector high = hn::Neg(infinity);
      for (int first = 0; first < RayPacket::Size; first += Width)
      {
        const Mask here = GetMask(rays, first);
        const Vector start = hn::Load(tag, packet.Origin[axis] + first);
        const Vector direction = hn::Load(tag, packet.Direction[axis] + first);
        const Vector in = hn::Add(start, hn::Mul(hn::Load(tag, enter + first), direction));
        const Vector out = hn::Add(start, hn::Mul(hn::Load(tag, leave + first), direction));
        low = hn::Min(low, hn::IfThenElse(here, hn::Min(in, out), infinity));
        high = hn::Max(high, hn::IfThenElse(here, hn::Max(in, out), hn::Neg(infinity)));
      }
      const double lowest = hn::GetLane(hn::MinOfLanes(tag, low)) - margin - origin[axis];
      const double highest = hn::GetLane(hn::MaxOfLanes(tag, high)) + margin - origin[axis];
      const int last = brick.GetMacrocells(axis) - 1;
      const auto toNode = [last](double place)
      { return static_cast<int>(std::clamp(place * (1.0 / MacrocellEdge), 0.0, double(last))); };
      box.First[axis] = toNode(lowest);
      box.Size[axis] = toNode(highest) - box.First[axis] + 1;
    }
    return box;
  }

  static void FillPlanes(
    const RayPacket& packet, const double origin[3], const NodeBox& box, PlaneTable& planes)
  {
    const D tag;
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int node = 0; node <= box.Size[axis]; ++node)
      {
        const double plane = origin[axis] + MacrocellEdge * (box.First[axis] + node);
        for (int first = 0; first < RayPacket::Size; first += Width)
        {
          hn::Store(
            GetPlaneT(packet, first, axis, plane), tag, planes[axis][node] + first);
        }
      }
    }
  }

  /// The macrocells of a row along x, in the order in which they are met.
  static RayPacket::Mask SearchRow(const RayPacket& packet, RayPacket::Mask rays,
    const PacketBrick& brick, const double origin[3], const double* enter, const double* leave,
    const NodeBox& box, const PlaneTable& planes, int y, int z,
    PacketCrossings& crossings)
  {
    const D tag;
    const int ahead[3] = { packet.Forward[0], packet.Forward[1], packet.Forward[2] };
    const int j = y - box.First[1];
    const int k = z - box.First[2];
    Vector rowEnter[Vectors];
    Vector rowLeave[Vectors];
    Mask inRow[Vectors];
    bool any = false;
    for (int part = 0; part < Vectors; ++part)
    {
      const int first = part * Width;
      rowEnter[part] = hn::Max(hn::Load(tag, enter + first),
        hn::Max(hn::Load(tag, planes[1][j + 1 - ahead[1]] + first),
          hn::Load(tag, planes[2][k + 1 - ahead[2]] + first)));
      rowLeave[part] = hn::Min(hn::Load(tag, leave + first),
        hn::Min(hn::Load(tag, planes[1][j + ahead[1]] + first),
          hn::Load(tag, planes[2][k + ahead[2]] + first)));
      inRow[part] = hn::And(GetMask(rays, first), hn::Lt(rowEnter[part], rowLeave[part]));
      any = any || !hn::AllFalse(tag, inRow[part]);
    }
    const std::uint64_t mayHold = any ? brick.FindMacrocells(y, z) : 0;
    RayPacket::Mask found = 0;
    for (int i = 0; i < box.Size[0] && mayHold != 0; ++i)
    {
      const int x = packet.Forward[0] ? i : box.Size[0] - 1 - i;
      if ((mayHold >> (box.First[0] + x) & 1) == 0)
      {
        continue;
      }
      const int place[3] = { MacrocellEdge * (box.First[0] + x), MacrocellEdge * y,
        MacrocellEdge * z };
      std::uint64_t cells = 0;
      bool haveCells = false;
      for (int part = 0; part < Vectors; ++part)
      {
        const int first = part * Width;
        const Vector in =
          hn::Max(rowEnter[part], hn::Load(tag, planes[0][x + 1 - ahead[0]] + first));
        const Vector out =
          hn::Min(rowLeave[part], hn::Load(tag, planes[0][x + ahead[0]] + first));
        const Mask meet = hn::And(inRow[part], hn::Lt(in, out));
        if (hn::AllFalse(tag, meet))
        {
          continue;
        }
        if (!haveCells)
        {
          cells = brick.FindCells(place);
          haveCells = true;
        }
        if (cells == 0)
        {
          break;
        }
        PacketWalk<D> walk(tag, packet, first, brick, origin, crossings);
        const Mask hit = walk.Search(place, cells, meet, in, out);
        inRow[part] = hn::AndNot(hit, inRow[part]);
        found |= GetBits(hit) << first;
      }
    }
    return found;
  }

  /// Where exactly the rays of `found` meet the surface.
  static void Refine(
    const PacketCrossings& crossings, RayPacket::Mask found, PacketHits& hits)
  {
    const D tag;
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
PacketKernel Create(const char* name)
{
  return { name, PacketSteps<D>::Width, &PacketSteps<D>::MeetBox, &PacketSteps<D>::SearchBrick };
}

PacketKernel CreateWide()
{
  return Create<hn::CappedTag<double, 8>>(hwy::TargetName(HWY_TARGET));
}

PacketKernel CreateSingle()
{
  return Create<hn::CappedTag<double, 1>>("one ray at a time");
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
  std::vector<PacketKernel> kernels{ HWY_DYNAMIC_DISPATCH(CreateSingle)() };
  for (const auto target : hwy::SupportedAndGeneratedTargets())
  {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
    kernels.push_back(HWY_DYNAMIC_DISPATCH(CreateWide)());
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return kernels;
}

} // namespace rt
#endif
