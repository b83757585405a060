// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see CellKernel.cxx.
#if defined(rt_TetrahedronCrossings_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_TetrahedronCrossings_inl_h
#undef rt_TetrahedronCrossings_inl_h
#else
#define rt_TetrahedronCrossings_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/field/tetrahedra/CellKernel.h"
#include "DSMRayTracing/field/tetrahedra/CellPacket.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Finds where rays cross the faces of tetrahedra, and the values there. Two tetrahedra that share a face get the same
/// bits there, in whatever order they name its points: each number comes from operations that do not depend on the
/// order, or of which only the sign does. As for triangles (TriangleIntersector.h), a ray does not pass between
/// tetrahedra that share a face, an edge or a corner. D: vectors of doubles, a ray and a tetrahedron in each lane.
template <class D>
class TetrahedronCrossings
{
public:
  /// Keeps references.
  TetrahedronCrossings(const CellPacket& packet, const CellKernel::Group& group)
    : Packet(packet)
    , Group(group)
  {
  }

  /// See CellKernel::FindCrossings.
  int Find(RayMask lanes, CellKernel::Crossing* crossings)
  {
    this->Next = crossings;
    SeenPoints seen[CellPacket::Size / FilterWidth];
    for (int chunk = 0; chunk * FilterWidth < this->Packet.Count; ++chunk)
    {
      if (GetPart(lanes, chunk * FilterWidth, FilterWidth) != 0)
      {
        this->LookAt(chunk * FilterWidth, seen[chunk]);
      }
    }
    for (int index = 0; index < this->Group.CellCount; ++index)
    {
      const CellKernel::Group::Cell& cell = this->Group.Cells[index];
      RayMask near = this->FindNear(seen, lanes, cell.At, this->Group.Corners);
      // Many rays look at the tetrahedra of one cell; few wait for others, until vectors are full.
      while (hwy::PopCount(near) > Width / 2)
      {
        near = this->FindInCell(cell, near);
      }
      for (int part = cell.FirstPart; near != 0 && part < cell.FirstPart + cell.Parts; ++part)
      {
        const RayMask wait = this->Group.Corners == 4
          ? near
          : this->FindNear(seen, near, this->Group.Tetrahedra[part], 4);
        ForEachRay(wait,
          [&](int lane)
          {
            this->Waiting.Add(lane, part);
            if (this->Waiting.Count == Width)
            {
              this->FindWaiting();
            }
          });
      }
    }
    this->FindWaiting();
    return static_cast<int>(this->Next - crossings);
  }

private:
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;
  using Filter = hn::CappedTag<float, 2 * hn::MaxLanes(D())>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));
  static constexpr int FilterWidth = static_cast<int>(hn::MaxLanes(Filter()));

  /// A point of a group as a ray sees it, after Woop et al. 2013: the ray goes along the third axis, in units of its T
  /// times Shear[2].
  struct SeenPoint
  {
    Vector X;
    Vector Y;
    Vector Depth;
    Vector Value;
  };
  /// Where rays enter and leave a tetrahedron, and the values there.
  struct Found
  {
    Vector Enter;
    Vector Exit;
    Vector First;
    Vector Last;
    Mask Once; ///< crosses a face
    Mask Twice;
  };

  ///@{
  /// As std::min and std::max, also for zeros and what is not a number.
  static HWY_INLINE Vector Min(Vector a, Vector b) { return hn::Min(b, a); }
  static HWY_INLINE Vector Max(Vector a, Vector b) { return hn::Max(b, a); }
  ///@}

  /// Where all points are before the rays of some lanes.
  using SeenPoints = hn::Vec<Filter>[CellKernel::Group::MostPoints][2];

  HWY_INLINE void LookAt(int first, SeenPoints& seen) const
  {
    const Filter tag;
    const CellPacket& packet = this->Packet;
    hn::Vec<Filter> start[3];
    for (int place = 0; place < 3; ++place)
    {
      start[place] = hn::Load(tag, packet.Start[packet.Axes[place]] + first);
    }
    const hn::Vec<Filter> shear[2] = { hn::Load(tag, packet.FilterShear[0] + first),
      hn::Load(tag, packet.FilterShear[1] + first) };
    for (std::uint64_t used = this->Group.Used; used != 0; used &= used - 1)
    {
      const int point = __builtin_ctzll(used);
      const float* const place = this->Group.Points[point].Place;
      const auto depth = hn::Sub(hn::Set(tag, place[2]), start[2]);
      for (int axis = 0; axis < 2; ++axis)
      {
        seen[point][axis] =
          hn::Sub(hn::Sub(hn::Set(tag, place[axis]), start[axis]), hn::Mul(shear[axis], depth));
      }
    }
  }

  /// Returns which of `lanes` may pass between some points, as they see them.
  HWY_INLINE RayMask FindNear(
    const SeenPoints* seen, RayMask lanes, const std::uint8_t* at, int corners) const
  {
    const Filter tag;
    RayMask near = 0;
    for (int first = 0; first < this->Packet.Count; first += FilterWidth)
    {
      if (GetPart(lanes, first, FilterWidth) == 0)
      {
        continue;
      }
      const SeenPoints& points = seen[first / FilterWidth];
      hn::Vec<Filter> least[2] = { points[at[0]][0], points[at[0]][1] };
      hn::Vec<Filter> most[2] = { least[0], least[1] };
      for (int corner = 1; corner < corners; ++corner)
      {
        for (int axis = 0; axis < 2; ++axis)
        {
          least[axis] = hn::Min(least[axis], points[at[corner]][axis]);
          most[axis] = hn::Max(most[axis], points[at[corner]][axis]);
        }
      }
      const auto margin = hn::Load(tag, this->Packet.Uncertainty + first);
      const auto isNear = hn::And(hn::Le(hn::Max(least[0], least[1]), margin),
        hn::Ge(hn::Min(most[0], most[1]), hn::Neg(margin)));
      near |= RayMask{ GetMaskBits(tag, isNear) } << first;
    }
    return near & lanes;
  }

  /// Rays and tetrahedra that are looked at together.
  struct Pairs
  {
    int Count = 0;
    int Lanes[Width] = {};
    int Parts[Width] = {};

    void Add(int lane, int part)
    {
      this->Lanes[this->Count] = lane;
      this->Parts[this->Count] = part;
      ++this->Count;
    }
    /// Lets the others do what the first one does. Returns the bits of those that count.
    std::uint32_t Fill()
    {
      std::fill(this->Lanes + this->Count, this->Lanes + Width, this->Lanes[0]);
      std::fill(this->Parts + this->Count, this->Parts + Width, this->Parts[0]);
      return (std::uint32_t{ 1 } << this->Count) - 1;
    }
  };
  struct Rays
  {
    Vector Origin[3];
    Vector Shear[3];
    Vector Min;
    Vector Max;
  };

  HWY_INLINE void LoadRays(const Pairs& pairs, Rays& rays) const
  {
    const D tag;
    HWY_ALIGN double numbers[2][4 * Width];
    for (int lane = 0; lane < Width; ++lane)
    {
      const CellPacket::LaneRay& ray = this->Packet.Lanes[pairs.Lanes[lane]];
      std::memcpy(numbers[0] + 4 * lane, ray.Origin, 4 * sizeof(double));
      std::memcpy(numbers[1] + 4 * lane, ray.Shear, 4 * sizeof(double));
    }
    hn::LoadInterleaved4(tag, numbers[0], rays.Origin[0], rays.Origin[1], rays.Origin[2], rays.Min);
    hn::LoadInterleaved4(tag, numbers[1], rays.Shear[0], rays.Shear[1], rays.Shear[2], rays.Max);
  }

  static HWY_INLINE SeenPoint See(const Rays& rays, Vector x, Vector y, Vector z, Vector value)
  {
    SeenPoint point;
    point.Depth = hn::Sub(z, rays.Origin[2]);
    point.X = hn::Sub(hn::Sub(x, rays.Origin[0]), hn::Mul(rays.Shear[0], point.Depth));
    point.Y = hn::Sub(hn::Sub(y, rays.Origin[1]), hn::Mul(rays.Shear[1], point.Depth));
    point.Value = value;
    return point;
  }

  /// Looks at the tetrahedra of a cell by as many of `lanes` as a vector has. Returns the others.
  HWY_INLINE RayMask FindInCell(const CellKernel::Group::Cell& cell, RayMask lanes)
  {
    Pairs pairs;
    for (; lanes != 0 && pairs.Count < Width; lanes &= lanes - 1)
    {
      pairs.Add(GetLowest(lanes), cell.FirstPart);
    }
    const std::uint32_t there = pairs.Fill();
    Rays rays;
    this->LoadRays(pairs, rays);
    const auto number = [](float value) { return hn::Set(D(), static_cast<double>(value)); };
    SeenPoint seen[CellKernel::Group::MostCorners];
    std::uint8_t corners[CellKernel::Group::MostPoints];
    for (int corner = 0; corner < this->Group.Corners; ++corner)
    {
      const CellKernel::Group::Point& point = this->Group.Points[cell.At[corner]];
      seen[corner] = See(rays, number(point.Place[0]), number(point.Place[1]),
        number(point.Place[2]), number(point.Value));
      corners[cell.At[corner]] = static_cast<std::uint8_t>(corner);
    }
    for (int part = cell.FirstPart; part < cell.FirstPart + cell.Parts; ++part)
    {
      const std::uint8_t* const at = this->Group.Tetrahedra[part];
      std::fill_n(pairs.Parts, Width, part);
      this->FindPart(rays, seen[corners[at[0]]], seen[corners[at[1]]], seen[corners[at[2]]],
        seen[corners[at[3]]], there, pairs);
    }
    return lanes;
  }

  /// Looks at the rays and tetrahedra that wait.
  HWY_NOINLINE void FindWaiting()
  {
    if (this->Waiting.Count == 0)
    {
      return;
    }
    const D tag;
    using Floats = hn::Rebind<float, D>;
    const std::uint32_t there = this->Waiting.Fill();
    HWY_ALIGN float corners[4][4 * Width];
    for (int pair = 0; pair < Width; ++pair)
    {
      const std::uint8_t* const at = this->Group.Tetrahedra[this->Waiting.Parts[pair]];
      for (int corner = 0; corner < 4; ++corner)
      {
        std::memcpy(corners[corner] + 4 * pair, &this->Group.Points[at[corner]],
          sizeof(CellKernel::Group::Point));
      }
    }
    Rays rays;
    this->LoadRays(this->Waiting, rays);
    SeenPoint seen[4];
    for (int corner = 0; corner < 4; ++corner)
    {
      hn::Vec<Floats> numbers[4];
      hn::LoadInterleaved4(
        Floats(), corners[corner], numbers[0], numbers[1], numbers[2], numbers[3]);
      seen[corner] = See(rays, hn::PromoteTo(tag, numbers[0]), hn::PromoteTo(tag, numbers[1]),
        hn::PromoteTo(tag, numbers[2]), hn::PromoteTo(tag, numbers[3]));
    }
    this->FindPart(rays, seen[0], seen[1], seen[2], seen[3], there, this->Waiting);
    this->Waiting.Count = 0;
  }

  /// `there`: bits of those that count.
  HWY_INLINE void FindPart(const Rays& rays, const SeenPoint& a, const SeenPoint& b,
    const SeenPoint& c, const SeenPoint& d, std::uint32_t there, const Pairs& pairs)
  {
    const D tag;
    Found found;
    FindFaces(rays.Shear[2], a, b, c, d, GetBitMask(tag, there), found);
    const Mask within = hn::And(hn::Ge(found.Exit, rays.Min), hn::Le(found.Enter, rays.Max));
    const std::uint32_t crossing = GetMaskBits(tag, hn::And(found.Twice, within));
    if (crossing != 0)
    {
      this->Write(found, crossing, pairs);
    }
  }

  /// Finds no face of any but `rays`.
  static HWY_INLINE void FindFaces(Vector scale, const SeenPoint& a, const SeenPoint& b,
    const SeenPoint& c, const SeenPoint& d, Mask rays, Found& found)
  {
    const D tag;
    found.Enter = hn::Set(tag, std::numeric_limits<double>::infinity());
    found.Exit = hn::Neg(found.Enter);
    found.First = hn::Zero(tag);
    found.Last = hn::Zero(tag);
    found.Once = hn::Lt(found.Enter, found.Exit);
    found.Twice = found.Once;
    const Vector ab = Cross(a, b);
    const Vector ac = Cross(a, c);
    const Vector ad = Cross(a, d);
    const Vector bc = Cross(b, c);
    const Vector bd = Cross(b, d);
    const Vector cd = Cross(c, d);
    AddFace(scale, a, b, c, bc, hn::Neg(ac), ab, rays, found);
    AddFace(scale, a, b, d, bd, hn::Neg(ad), ab, rays, found);
    AddFace(scale, a, c, d, cd, hn::Neg(ad), ac, rays, found);
    AddFace(scale, b, c, d, cd, hn::Neg(bd), bc, rays, found);
  }

  static HWY_INLINE Vector Cross(const SeenPoint& one, const SeenPoint& other)
  {
    return hn::Sub(hn::Mul(one.X, other.Y), hn::Mul(one.Y, other.X));
  }

  /// Does not depend on the order of the numbers. If all are negated, so is the sum.
  static HWY_INLINE Vector Sum(Vector a, Vector b, Vector c)
  {
    const Vector less = Min(a, b);
    const Vector more = Max(a, b);
    const Vector middle = Max(less, Min(more, c));
    return hn::Add(hn::Add(Min(less, c), Max(more, c)), middle);
  }

  static HWY_INLINE void AddFace(Vector scale, const SeenPoint& a, const SeenPoint& b,
    const SeenPoint& c, Vector u, Vector v, Vector w, Mask rays, Found& found)
  {
    const D tag;
    const Vector zero = hn::Zero(tag);
    const Mask isAnyLess = hn::Lt(hn::Min(hn::Min(u, v), w), zero);
    const Mask isAnyMore = hn::Gt(hn::Max(hn::Max(u, v), w), zero);
    const Mask oneSided = hn::AndNot(hn::And(isAnyLess, isAnyMore), rays);
    if (hn::AllFalse(tag, oneSided))
    {
      return;
    }
    const Vector determinant = Sum(u, v, w);
    const Mask meets = hn::And(oneSided, hn::Ne(determinant, zero));
    const Vector inverse = hn::Div(hn::Set(tag, 1.0), determinant);
    const auto interpolate = [&](Vector one, Vector two, Vector three)
    { return hn::Mul(Sum(hn::Mul(u, one), hn::Mul(v, two), hn::Mul(w, three)), inverse); };
    const Vector t = hn::Mul(interpolate(a.Depth, b.Depth, c.Depth), scale);
    const Vector least = Min(Min(a.Value, b.Value), c.Value);
    const Vector most = Max(Max(a.Value, b.Value), c.Value);
    Vector value = interpolate(a.Value, b.Value, c.Value);
    value =
      hn::IfThenElse(hn::Lt(value, least), least, hn::IfThenElse(hn::Lt(most, value), most, value));
    const Mask isFirst = hn::And(meets, hn::Lt(t, found.Enter));
    const Mask isLast = hn::And(meets, hn::Gt(t, found.Exit));
    found.Enter = hn::IfThenElse(isFirst, t, found.Enter);
    found.First = hn::IfThenElse(isFirst, value, found.First);
    found.Exit = hn::IfThenElse(isLast, t, found.Exit);
    found.Last = hn::IfThenElse(isLast, value, found.Last);
    found.Twice = hn::Or(found.Twice, hn::And(found.Once, meets));
    found.Once = hn::Or(found.Once, meets);
  }

  HWY_INLINE void Write(const Found& found, std::uint32_t crossing, const Pairs& pairs)
  {
    const D tag;
    HWY_ALIGN double numbers[4][Width];
    hn::Store(found.Enter, tag, numbers[0]);
    hn::Store(found.Exit, tag, numbers[1]);
    hn::Store(found.First, tag, numbers[2]);
    hn::Store(found.Last, tag, numbers[3]);
    for (; crossing != 0; crossing &= crossing - 1)
    {
      const int pair = __builtin_ctz(crossing);
      *this->Next++ = { numbers[0][pair], numbers[1][pair], numbers[2][pair], numbers[3][pair],
        static_cast<std::uint8_t>(pairs.Lanes[pair]),
        static_cast<std::uint8_t>(pairs.Parts[pair]) };
    }
  }

  const CellPacket& Packet;
  const CellKernel::Group& Group;
  CellKernel::Crossing* Next = nullptr;
  Pairs Waiting; ///< fewer than Width
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
