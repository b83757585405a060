// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_PacketWalk_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_PacketWalk_inl_h
#undef rt_PacketWalk_inl_h
#else
#define rt_PacketWalk_inl_h
#endif

#include "DSMRayTracing/brick/VoxelBrickHeader.h"
#include "DSMRayTracing/kernel/PacketBrick.h"
#include "DSMRayTracing/kernel/PacketCrossing-inl.h"
#include "DSMRayTracing/kernel/RayPacket.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Rays that meet the surface in a cell, before it is known where in the cell.
struct PacketCrossings
{
  static constexpr int Size = RayPacket::Size;

  HWY_ALIGN double Coefficients[4][Size];
  HWY_ALIGN double BeginS[Size];
  HWY_ALIGN double BeginValue[Size];
  HWY_ALIGN double EndS[Size];
  HWY_ALIGN double EndValue[Size];
  /// Where the ray is in the cell.
  HWY_ALIGN double Enter[Size];
  HWY_ALIGN double Leave[Size];
  HWY_ALIGN double Start[3][Size];
  HWY_ALIGN double Way[3][Size];
  HWY_ALIGN double Cell[3][Size]; ///< of the brick
};

/// Into [0, 1].
template <class Vector>
Vector ClampToUnit(Vector value)
{
  const hn::DFromV<Vector> tag;
  const Vector zero = hn::Zero(tag);
  const Vector one = hn::Set(tag, 1.0);
  const Vector raised = hn::IfThenElse(hn::Gt(value, zero), value, zero);
  return hn::IfThenElse(hn::Lt(raised, one), raised, one);
}

/// One vector of a packet's rays in the cells of one macrocell; what GridTraversal::WalkCells does
/// for one ray, with the same bits. A ray walks on until it comes to a cell that has corners on both
/// sides; when all have come to one, or to their ends, the cells are searched together.
template <class D>
class PacketWalk
{
public:
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;

  /// Rays `first` and on of the packet, in the brick whose first cell is `origin`.
  PacketWalk(D tag, const RayPacket& packet, int first, const PacketBrick& brick,
    const double origin[3], PacketCrossings& crossings)
    : Tag(tag)
    , Brick(brick)
    , First(first)
    , Crossings(crossings)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Origin[axis] = hn::Load(tag, packet.Origin[axis] + first);
      this->Direction[axis] = hn::Load(tag, packet.Direction[axis] + first);
      this->Inverse[axis] = hn::Load(tag, packet.Inverse[axis] + first);
      this->BrickOrigin[axis] = origin[axis];
      this->Forward[axis] = packet.Forward[axis];
    }
  }

  /// Searches the macrocell with the first cell `place`; bit x + 4 y + 16 z of `cells` is set for
  /// those to search. `rays` cross it from `enter` to `leave`. Returns those that meet the surface,
  /// having stored how.
  Mask Search(const int place[3], std::uint64_t cells, Mask rays, Vector enter, Vector leave)
  {
    const D tag = this->Tag;
    this->Start(place, enter);
    const auto bits = hn::Set(this->Numbers, cells);
    const auto lowest = hn::Set(this->Numbers, std::uint64_t{ 1 });
    Vector t = enter;
    Vector exit = leave;
    Mask found = hn::MaskFromVec(hn::Zero(tag));
    Mask walking = rays;
    while (!hn::AllFalse(tag, walking))
    {
      Mask waiting = hn::MaskFromVec(hn::Zero(tag));
      while (!hn::AllFalse(tag, walking))
      {
        const Vector near = hn::Min(hn::Min(this->PlaneT[0], this->PlaneT[1]), this->PlaneT[2]);
        exit = hn::IfThenElse(walking, hn::Min(near, leave), exit);
        const Mask mixed = hn::And(walking,
          hn::RebindMask(tag, hn::Eq(hn::And(hn::Shr(bits, this->Cell), lowest), lowest)));
        waiting = hn::Or(waiting, mixed);
        walking = hn::And(hn::AndNot(mixed, walking), hn::Lt(exit, leave));
        t = hn::IfThenElse(walking, exit, t);
        this->Advance(walking, exit);
      }
      if (hn::AllFalse(tag, waiting))
      {
        break;
      }
      const Mask met = this->SearchCells(place, waiting, t, exit);
      found = hn::Or(found, met);
      walking = hn::And(hn::AndNot(met, waiting), hn::Lt(exit, leave));
      t = hn::IfThenElse(walking, exit, t);
      this->Advance(walking, exit);
    }
    return found;
  }

private:
  using NumberTag = hn::RebindToUnsigned<D>;
  using Number = hn::Vec<NumberTag>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  Vector GetPlaneT(int axis, Vector plane) const
  {
    return hn::Mul(hn::Sub(plane, this->Origin[axis]), this->Inverse[axis]);
  }

  /// Planes that are met at t or before count as crossed.
  void Start(const int place[3], Vector t)
  {
    const D tag = this->Tag;
    this->Cell = hn::Zero(this->Numbers);
    for (int axis = 0; axis < 3; ++axis)
    {
      const int count = HWY_MIN(MacrocellEdge, this->Brick.GetCells(axis) - place[axis]);
      const double first = this->BrickOrigin[axis] + place[axis];
      const bool forward = this->Forward[axis];
      const double step = forward ? 1.0 : -1.0;
      // The planes between the cells, in the order in which they are met.
      double plane = forward ? first + 1.0 : first + count - 1.0;
      Vector cell = hn::Set(tag, forward ? 0.0 : count - 1.0);
      for (int between = 1; between < count; ++between, plane += step)
      {
        const Mask crossed = hn::Le(this->GetPlaneT(axis, hn::Set(tag, plane)), t);
        cell = hn::Add(cell, hn::IfThenElseZero(crossed, hn::Set(tag, step)));
      }
      this->Plane[axis] = hn::Add(hn::Set(tag, first + (forward ? 1.0 : 0.0)), cell);
      this->PlaneT[axis] = this->GetPlaneT(axis, this->Plane[axis]);
      this->Step[axis] = hn::Set(tag, step);
      // Whole numbers below 2^52, added to it, stand in the lowest bits.
      const Vector large = hn::Set(tag, 4503599627370496.0);
      const auto whole = hn::Sub(hn::BitCast(this->Numbers, hn::Add(large, cell)),
        hn::BitCast(this->Numbers, large));
      this->Cell = hn::Add(this->Cell, hn::ShiftLeftSame(whole, 2 * axis));
      const std::uint64_t stride = std::uint64_t{ 1 } << (2 * axis);
      this->Stride[axis] = hn::Set(this->Numbers, forward ? stride : 0 - stride);
    }
  }

  /// Crosses all planes that `rays` meet at `exit` or before.
  void Advance(Mask rays, Vector exit)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const Mask crossed = hn::And(rays, hn::Le(this->PlaneT[axis], exit));
      this->Plane[axis] =
        hn::Add(this->Plane[axis], hn::IfThenElseZero(crossed, this->Step[axis]));
      this->Cell = hn::Add(this->Cell,
        hn::IfThenElseZero(hn::RebindMask(this->Numbers, crossed), this->Stride[axis]));
      this->PlaneT[axis] = this->GetPlaneT(axis, this->Plane[axis]);
    }
  }

  /// Where rays are in their cells at `t`: exactly 0 or 1 where they meet a plane of the cell.
  Vector GetLocal(int axis, Vector lower, Vector lowerT, Vector upperT, Vector t) const
  {
    const Vector point = hn::Add(this->Origin[axis], hn::Mul(t, this->Direction[axis]));
    const Vector inside = ClampToUnit(hn::Sub(point, lower));
    return hn::IfThenElse(hn::Eq(upperT, t), hn::Set(this->Tag, 1.0),
      hn::IfThenZeroElse(hn::Eq(lowerT, t), inside));
  }

  /// Those of `rays` that meet the surface in the cells in which they are, from `enter` to `exit`.
  Mask SearchCells(const int place[3], Mask rays, Vector enter, Vector exit)
  {
    const D tag = this->Tag;
    HWY_ALIGN double corners[8][Width] = {};
    rays = this->GetCorners(place, rays, corners[0]);
    if (hn::AllFalse(tag, rays))
    {
      return rays;
    }
    Vector values[8];
    for (int corner = 0; corner < 8; ++corner)
    {
      values[corner] = hn::Load(tag, corners[corner]);
    }
    const Vector one = hn::Set(tag, 1.0);
    Vector start[3];
    Vector end[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector lower =
        this->Forward[axis] ? hn::Sub(this->Plane[axis], one) : this->Plane[axis];
      const Vector lowerT = this->GetPlaneT(axis, lower);
      const Vector upperT = this->GetPlaneT(axis, hn::Add(lower, one));
      start[axis] = this->GetLocal(axis, lower, lowerT, upperT, enter);
      end[axis] = this->GetLocal(axis, lower, lowerT, upperT, exit);
    }
    const PacketCrossing<D> crossing(tag, values, start, end);
    Bracket<D> bracket;
    const Mask found = crossing.FindFirst(rays, bracket);
    if (hn::AllFalse(tag, found))
    {
      return found;
    }
    Vector coefficients[4];
    crossing.GetCoefficients(coefficients);
    for (int power = 0; power < 4; ++power)
    {
      this->Put(found, coefficients[power], this->Crossings.Coefficients[power]);
    }
    this->Put(found, bracket.BeginS, this->Crossings.BeginS);
    this->Put(found, bracket.BeginValue, this->Crossings.BeginValue);
    this->Put(found, bracket.EndS, this->Crossings.EndS);
    this->Put(found, bracket.EndValue, this->Crossings.EndValue);
    this->Put(found, enter, this->Crossings.Enter);
    this->Put(found, exit, this->Crossings.Leave);
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Put(found, start[axis], this->Crossings.Start[axis]);
      this->Put(found, hn::Sub(end[axis], start[axis]), this->Crossings.Way[axis]);
      const Vector lower =
        this->Forward[axis] ? hn::Sub(this->Plane[axis], one) : this->Plane[axis];
      this->Put(found, hn::Sub(lower, hn::Set(tag, this->BrickOrigin[axis])),
        this->Crossings.Cell[axis]);
    }
    return found;
  }

  /// Corners of the cells in which `rays` are, those of a ray under one another. Returns the rays
  /// whose cells hold data.
  Mask GetCorners(const int place[3], Mask rays, double* corners) const
  {
    HWY_ALIGN std::uint64_t cells[Width];
    hn::Store(this->Cell, this->Numbers, cells);
    std::uint8_t wanted[8] = {};
    hn::StoreMaskBits(this->Tag, rays, wanted);
    std::uint8_t held[8] = {};
    for (int ray = 0; ray < Width; ++ray)
    {
      if ((wanted[0] >> ray & 1) == 0)
      {
        continue;
      }
      const auto number = static_cast<int>(cells[ray]);
      const int cell[3] = { place[0] + (number & 3), place[1] + (number >> 2 & 3),
        place[2] + (number >> 4) };
      if (this->Brick.GetCorners(cell, corners + ray, Width))
      {
        held[0] = static_cast<std::uint8_t>(held[0] | 1u << ray);
      }
    }
    return hn::LoadMaskBits(this->Tag, held);
  }

  /// Stores the numbers of some rays.
  void Put(Mask rays, Vector value, double* to) const
  {
    hn::BlendedStore(value, rays, this->Tag, to + this->First);
  }

  D Tag;
  NumberTag Numbers;
  const PacketBrick& Brick;
  int First;
  PacketCrossings& Crossings;
  double BrickOrigin[3];
  bool Forward[3];
  Vector Origin[3];
  Vector Direction[3];
  Vector Inverse[3];
  Vector Plane[3];  ///< coordinate of the plane through which a ray leaves its cell
  Vector PlaneT[3]; ///< where it meets that plane
  Vector Step[3];
  Number Stride[3]; ///< of the cell's number
  Number Cell; ///< x + 4 y + 16 z within the macrocell
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
