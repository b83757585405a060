// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_PacketWalk_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_PacketWalk_inl_h
#undef rt_PacketWalk_inl_h
#else
#define rt_PacketWalk_inl_h
#endif

#include "DSMRayTracing/brick/VoxelBrickHeader.h"
#include "DSMRayTracing/kernel/MaskBits-inl.h"
#include "DSMRayTracing/kernel/PacketBrick.h"
#include "DSMRayTracing/kernel/PacketCrossing-inl.h"
#include "DSMRayTracing/kernel/RayPacket.h"

#include <hwy/highway.h>

#include <cstdint>

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

/// One vector of rays.
template <class D>
struct RayVector
{
  using Vector = hn::Vec<D>;

  Vector Origin[3];
  Vector Direction[3];
  Vector Inverse[3];
  bool Forward[3];

  /// Rays `first` and on of a packet.
  RayVector(D tag, const RayPacket& packet, int first)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Origin[axis] = hn::Load(tag, packet.Origin[axis] + first);
      this->Direction[axis] = hn::Load(tag, packet.Direction[axis] + first);
      this->Inverse[axis] = hn::Load(tag, packet.Inverse[axis] + first);
      this->Forward[axis] = packet.Forward[axis];
    }
  }

  Vector GetPlaneT(int axis, Vector plane) const
  {
    return hn::Mul(hn::Sub(plane, this->Origin[axis]), this->Inverse[axis]);
  }
};

/// Whole numbers from 0 to 2^52.
template <class Vector>
auto ToNumbers(Vector whole)
{
  const hn::DFromV<Vector> tag;
  const hn::RebindToUnsigned<decltype(tag)> numbers;
  // Added to this, they stand in the lowest bits.
  const Vector large = hn::Set(tag, 4503599627370496.0);
  return hn::Sub(hn::BitCast(numbers, hn::Add(large, whole)), hn::BitCast(numbers, large));
}

/// Walks of a vector of rays, each through a box of 4 x 4 x 4 nodes of its own, of one size; what
/// GridWalk does for one ray. Where the volume ends within a box, its planes outside are met before
/// the ray enters, or after it leaves.
template <class D>
class NodeWalks
{
public:
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;
  using NumberTag = hn::RebindToUnsigned<D>;
  using Numbers = hn::Vec<NumberTag>;

  /// `lower`: the lower planes of the boxes. Planes that are met at t or before count as crossed.
  NodeWalks(const RayVector<D>& rays, const Vector lower[3], double edge, Vector t)
    : Rays(rays)
    , Nodes(hn::Zero(NumberTag()))
  {
    const D tag;
    const NumberTag numbers;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool forward = rays.Forward[axis];
      const Vector step = hn::Set(tag, forward ? edge : -edge);
      Vector node = hn::Set(tag, forward ? 0.0 : 3.0 * edge);
      // The planes between the nodes, in any order.
      for (int between = 1; between < 4; ++between)
      {
        const Vector plane = hn::Add(lower[axis], hn::Set(tag, between * edge));
        const Mask crossed = hn::Le(rays.GetPlaneT(axis, plane), t);
        node = hn::Add(node, hn::IfThenElseZero(crossed, step));
      }
      this->Plane[axis] = hn::Add(hn::Add(lower[axis], node), hn::Set(tag, forward ? edge : 0.0));
      this->PlaneT[axis] = rays.GetPlaneT(axis, this->Plane[axis]);
      this->Step[axis] = step;
      const Numbers whole = ToNumbers(hn::Mul(node, hn::Set(tag, 1.0 / edge)));
      this->Nodes = hn::Add(this->Nodes, hn::ShiftLeftSame(whole, 2 * axis));
      const std::uint64_t stride = std::uint64_t{ 1 } << (2 * axis);
      this->Stride[axis] = hn::Set(numbers, forward ? stride : 0 - stride);
    }
  }

  /// x + 4 y + 16 z of the nodes in which the rays are.
  Numbers GetNodes() const { return this->Nodes; }

  /// Where the rays leave their nodes.
  Vector GetExit() const
  {
    return hn::Min(hn::Min(this->PlaneT[0], this->PlaneT[1]), this->PlaneT[2]);
  }

  /// The lower planes of the nodes.
  Vector GetLower(int axis) const
  {
    return this->Rays.Forward[axis] ? hn::Sub(this->Plane[axis], this->Step[axis])
                                    : this->Plane[axis];
  }

  /// Goes on until each of `walking` is in a node whose bit is set in `bits`, or has ended at
  /// `leave`. Returns those in such a node, which they cross from `t`, where they are now, to `exit`.
  Mask FindNodes(Mask walking, Numbers bits, Vector leave, Vector& t, Vector& exit)
  {
    const D tag;
    const Numbers lowest = hn::Set(NumberTag(), std::uint64_t{ 1 });
    Mask waiting = hn::MaskFromVec(hn::Zero(tag));
    while (!hn::AllFalse(tag, walking))
    {
      exit = hn::IfThenElse(walking, hn::Min(this->GetExit(), leave), exit);
      const Mask here = hn::And(
        walking, hn::RebindMask(tag, hn::Eq(hn::And(hn::Shr(bits, this->Nodes), lowest), lowest)));
      waiting = hn::Or(waiting, here);
      walking = this->Leave(hn::AndNot(here, walking), leave, t, exit);
    }
    return waiting;
  }

  /// Moves `rays` out of their nodes, at `exit`; returns those that have not ended there.
  Mask Leave(Mask rays, Vector leave, Vector& t, Vector exit)
  {
    rays = hn::And(rays, hn::Lt(exit, leave));
    t = hn::IfThenElse(rays, exit, t);
    for (int axis = 0; axis < 3; ++axis)
    {
      const Mask crossed = hn::And(rays, hn::Le(this->PlaneT[axis], exit));
      this->Plane[axis] = hn::Add(this->Plane[axis], hn::IfThenElseZero(crossed, this->Step[axis]));
      this->Nodes = hn::Add(
        this->Nodes, hn::IfThenElseZero(hn::RebindMask(NumberTag(), crossed), this->Stride[axis]));
      this->PlaneT[axis] = this->Rays.GetPlaneT(axis, this->Plane[axis]);
    }
    return rays;
  }

private:
  const RayVector<D>& Rays;
  Vector Plane[3];  ///< coordinate of the plane through which a ray leaves its node
  Vector PlaneT[3]; ///< where it meets that plane
  Vector Step[3];
  Numbers Stride[3]; ///< of the node's number
  Numbers Nodes;
};

/// One vector of a packet's rays in a part of a brick; what GridTraversal does for one ray, with the
/// same bits. A ray walks on until it comes to a macrocell, and then to a cell, that may hold the
/// surface; when all have come to one, or to their ends, those are searched together.
template <class D>
class PacketWalk
{
public:
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;

  /// Rays `first` and on of the packet, in the brick whose first cell is `origin`. `crossings` is null
  /// when only those that meet the surface are asked for, not where.
  PacketWalk(D tag, const RayPacket& packet, int first, const PacketBrick& brick,
    const double origin[3], PacketCrossings* crossings)
    : Tag(tag)
    , Rays(tag, packet, first)
    , Brick(brick)
    , BrickOrigin(origin)
    , First(first)
    , Crossings(crossings)
  {
  }

  /// Searches a part of the brick. `rays` cross it from `enter` to `leave`. Returns those that meet
  /// the surface, having stored how.
  HWY_INLINE Mask Search(
    const int part[3], const PacketPart& macrocells, Mask rays, Vector enter, Vector leave)
  {
    const D tag = this->Tag;
    Vector lower[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      lower[axis] = hn::Set(tag, this->BrickOrigin[axis] + 4.0 * MacrocellEdge * part[axis]);
    }
    NodeWalks<D> walks(this->Rays, lower, MacrocellEdge, enter);
    const Numbers bits = hn::Set(NumberTag(), macrocells.Macrocells);
    Vector t = enter;
    Vector exit = leave;
    Mask found = hn::MaskFromVec(hn::Zero(tag));
    Mask walking = rays;
    for (;;)
    {
      const Mask waiting = walks.FindNodes(walking, bits, leave, t, exit);
      if (hn::AllFalse(tag, waiting))
      {
        return found;
      }
      const Mask met = this->SearchMacrocells(part, macrocells, walks, waiting, t, exit);
      found = hn::Or(found, met);
      walking = walks.Leave(hn::AndNot(met, waiting), leave, t, exit);
    }
  }

private:
  using NumberTag = hn::RebindToUnsigned<D>;
  using Numbers = hn::Vec<NumberTag>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  /// The macrocells in which `rays` are, from `enter` to `leave`.
  HWY_INLINE Mask SearchMacrocells(const int part[3], const PacketPart& found,
    const NodeWalks<D>& macrocells, Mask rays, Vector enter, Vector leave)
  {
    const D tag = this->Tag;
    const Numbers cells = this->FindCells(part, found, macrocells.GetNodes(), rays);
    const Vector lower[3] = { macrocells.GetLower(0), macrocells.GetLower(1),
      macrocells.GetLower(2) };
    NodeWalks<D> walks(this->Rays, lower, 1.0, enter);
    Vector t = enter;
    Vector exit = leave;
    Mask hit = hn::MaskFromVec(hn::Zero(tag));
    Mask walking = rays;
    for (;;)
    {
      const Mask waiting = walks.FindNodes(walking, cells, leave, t, exit);
      if (hn::AllFalse(tag, waiting))
      {
        return hit;
      }
      const Mask met = this->SearchCells(walks, waiting, t, exit);
      hit = hn::Or(hit, met);
      walking = walks.Leave(hn::AndNot(met, waiting), leave, t, exit);
    }
  }

  /// The cells of the macrocells in which `rays` are.
  HWY_INLINE Numbers FindCells(
    const int part[3], const PacketPart& found, Numbers macrocells, Mask rays) const
  {
    const NumberTag numbers;
    const hn::RebindToSigned<D> integers;
    const Numbers one = hn::Set(numbers, std::uint64_t{ 1 });
    const Numbers known = hn::And(hn::Shr(hn::Set(numbers, found.Known), macrocells), one);
    const Mask unknown = hn::AndNot(hn::RebindMask(this->Tag, hn::Eq(known, one)), rays);
    if (!hn::AllFalse(this->Tag, unknown))
    {
      HWY_ALIGN std::uint64_t places[Width];
      hn::Store(macrocells, numbers, places);
      this->Brick.FindCells(part, GetBits(unknown), places);
    }
    const auto places =
      hn::BitCast(integers, hn::IfThenElseZero(hn::RebindMask(numbers, rays), macrocells));
    return hn::GatherIndex(numbers, found.Cells, places);
  }

  unsigned GetBits(Mask rays) const { return GetMaskBits(this->Tag, rays); }

  /// Coordinates of the cells in which rays are, in the brick.
  Vector GetPlace(int axis, const NodeWalks<D>& cells) const
  {
    return hn::Sub(cells.GetLower(axis), hn::Set(this->Tag, this->BrickOrigin[axis]));
  }

  /// The corners of the cells of `rays`, less the isovalue; returns those whose cells hold data.
  HWY_INLINE Mask LoadCorners(Mask rays, const NodeWalks<D>& cells, Vector values[8]) const
  {
    const D tag = this->Tag;
    const PacketBrick::FloatSamples& samples = this->Brick.Floats;
    const hn::RebindToSigned<D> integers;
    const hn::Rebind<float, D> floats;
    const hn::RebindToUnsigned<decltype(floats)> words;
    const Vector row = hn::Mul(this->GetPlace(1, cells), hn::Set(tag, samples.Row));
    const Vector slice = hn::Mul(this->GetPlace(2, cells), hn::Set(tag, samples.Slice));
    const Vector place =
      hn::IfThenElseZero(rays, hn::Add(hn::Add(this->GetPlace(0, cells), row), slice));
    const auto bytes = hn::ShiftLeft<2>(hn::BitCast(integers, ToNumbers(place)));
    const Vector isovalue = hn::Set(tag, samples.Isovalue);
    Vector check = hn::Zero(tag);
    for (int pair = 0; pair < 4; ++pair)
    {
      const float* const first = samples.First + (pair & 1) * static_cast<int>(samples.Row) +
        (pair >> 1) * static_cast<int>(samples.Slice);
      // A row of two corners at once.
      const Numbers both = hn::BitCast(NumberTag(),
        hn::GatherOffset(integers, reinterpret_cast<const std::int64_t*>(first), bytes));
      const auto low = hn::BitCast(floats, hn::TruncateTo(words, both));
      const auto high = hn::BitCast(floats, hn::TruncateTo(words, hn::ShiftRight<32>(both)));
      values[2 * pair] = hn::Sub(hn::PromoteTo(tag, low), isovalue);
      values[2 * pair + 1] = hn::Sub(hn::PromoteTo(tag, high), isovalue);
      // Becomes, and stays, not a number where one of them is not finite.
      check =
        hn::Add(check, hn::Mul(hn::Add(values[2 * pair], values[2 * pair + 1]), hn::Zero(tag)));
    }
    return hn::And(rays, hn::Eq(check, hn::Zero(tag)));
  }

  /// The same for samples of other types, and where cells are masked.
  HWY_INLINE Mask AskForCorners(Mask rays, const NodeWalks<D>& cells, Vector values[8]) const
  {
    const D tag = this->Tag;
    HWY_ALIGN double corners[8][Width];
    for (double* const corner : corners)
    {
      hn::Store(hn::Zero(tag), tag, corner);
    }
    HWY_ALIGN double places[3][Width];
    for (int axis = 0; axis < 3; ++axis)
    {
      hn::Store(this->GetPlace(axis, cells), tag, places[axis]);
    }
    const std::uint8_t held[8] = { static_cast<std::uint8_t>(
      this->Brick.GetCorners(GetBits(rays), places[0], corners[0], Width)) };
    for (int corner = 0; corner < 8; ++corner)
    {
      values[corner] = hn::Load(tag, corners[corner]);
    }
    return hn::LoadMaskBits(tag, held);
  }

  /// Where rays are in their cells at `t`: exactly 0 or 1 where they meet a plane of the cell.
  Vector GetLocal(int axis, Vector lower, Vector lowerT, Vector upperT, Vector t) const
  {
    const Vector point = hn::Add(this->Rays.Origin[axis], hn::Mul(t, this->Rays.Direction[axis]));
    const Vector inside = ClampToUnit(hn::Sub(point, lower));
    return hn::IfThenElse(
      hn::Eq(upperT, t), hn::Set(this->Tag, 1.0), hn::IfThenZeroElse(hn::Eq(lowerT, t), inside));
  }

  /// Those of `rays` that meet the surface in the cells in which they are, from `enter` to `exit`.
  HWY_INLINE Mask SearchCells(const NodeWalks<D>& cells, Mask rays, Vector enter, Vector exit)
  {
    const D tag = this->Tag;
    Vector values[8];
    rays = this->Brick.Floats.First ? this->LoadCorners(rays, cells, values)
                                    : this->AskForCorners(rays, cells, values);
    if (hn::AllFalse(tag, rays))
    {
      return rays;
    }
    const Vector one = hn::Set(tag, 1.0);
    Vector start[3];
    Vector end[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector lower = cells.GetLower(axis);
      const Vector lowerT = this->Rays.GetPlaneT(axis, lower);
      const Vector upperT = this->Rays.GetPlaneT(axis, hn::Add(lower, one));
      start[axis] = this->GetLocal(axis, lower, lowerT, upperT, enter);
      end[axis] = this->GetLocal(axis, lower, lowerT, upperT, exit);
    }
    const PacketCrossing<D> crossing(tag, values, start, end);
    Bracket<D> bracket;
    const Mask found = crossing.FindFirst(rays, bracket);
    if (!this->Crossings || hn::AllFalse(tag, found))
    {
      return found;
    }
    PacketCrossings& crossings = *this->Crossings;
    Vector coefficients[4];
    crossing.GetCoefficients(coefficients);
    for (int power = 0; power < 4; ++power)
    {
      this->Put(found, coefficients[power], crossings.Coefficients[power]);
    }
    this->Put(found, bracket.BeginS, crossings.BeginS);
    this->Put(found, bracket.BeginValue, crossings.BeginValue);
    this->Put(found, bracket.EndS, crossings.EndS);
    this->Put(found, bracket.EndValue, crossings.EndValue);
    this->Put(found, enter, crossings.Enter);
    this->Put(found, exit, crossings.Leave);
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Put(found, start[axis], crossings.Start[axis]);
      this->Put(found, hn::Sub(end[axis], start[axis]), crossings.Way[axis]);
      this->Put(found, this->GetPlace(axis, cells), crossings.Cell[axis]);
    }
    return found;
  }

  /// Stores the numbers of some rays.
  void Put(Mask rays, Vector value, double* to) const
  {
    hn::BlendedStore(value, rays, this->Tag, to + this->First);
  }

  D Tag;
  RayVector<D> Rays;
  const PacketBrick& Brick;
  const double* BrickOrigin;
  int First;
  PacketCrossings* Crossings;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
