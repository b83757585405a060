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

#include <cstdint>
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
/// tetrahedra that share a face, an edge or a corner. D: vectors of doubles, a ray in each lane.
template <class D>
class TetrahedronCrossings
{
public:
  /// Keeps references.
  TetrahedronCrossings(const CellPacket& packet, const CellKernel::Cell& cell)
    : Packet(packet)
    , Cell(cell)
  {
  }

  /// See CellKernel::FindCrossings. `lanes` is not empty.
  int Find(RayMask lanes, CellKernel::Crossing* crossings)
  {
    this->Next = crossings;
    while (lanes != 0)
    {
      int count = 0;
      for (; lanes != 0 && count < Width; lanes &= lanes - 1)
      {
        this->Lanes[count++] = GetLowest(lanes);
      }
      // The others do what the first one does, and are not looked at.
      for (int lane = count; lane < Width; ++lane)
      {
        this->Lanes[lane] = this->Lanes[0];
      }
      this->FindTogether((std::uint32_t{ 1 } << count) - 1);
    }
    return static_cast<int>(this->Next - crossings);
  }

private:
  using Vector = hn::Vec<D>;
  using Mask = hn::Mask<D>;
  using NumberTag = hn::RebindToSigned<D>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  /// A point of a cell as a ray sees it, after Woop et al. 2013: the ray goes along the third axis, in units of its T
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

  HWY_INLINE Vector Load(const double* numbers) const
  {
    return hn::GatherIndex(D(), numbers, hn::Load(NumberTag(), this->Lanes));
  }

  /// `there`: bits of those of Lanes that count.
  HWY_INLINE void FindTogether(std::uint32_t there)
  {
    const D tag;
    const CellPacket& packet = this->Packet;
    const Vector origin[3] = { this->Load(packet.Origin[0]), this->Load(packet.Origin[1]),
      this->Load(packet.Origin[2]) };
    const Vector shear[2] = { this->Load(packet.Shear[0]), this->Load(packet.Shear[1]) };
    SeenPoint seen[CellKernel::Cell::MostCorners];
    const auto number = [&](float value) { return hn::Set(tag, static_cast<double>(value)); };
    for (int corner = 0; corner < this->Cell.Corners; ++corner)
    {
      SeenPoint& point = seen[corner];
      point.Depth = hn::Sub(number(this->Cell.Points[2][corner]), origin[2]);
      point.X = hn::Sub(
        hn::Sub(number(this->Cell.Points[0][corner]), origin[0]), hn::Mul(shear[0], point.Depth));
      point.Y = hn::Sub(
        hn::Sub(number(this->Cell.Points[1][corner]), origin[1]), hn::Mul(shear[1], point.Depth));
      point.Value = number(this->Cell.Values[corner]);
    }
    there &= this->FindAround(seen);
    if (there == 0)
    {
      return;
    }
    const Vector scale = this->Load(packet.Shear[2]);
    const Vector min = this->Load(packet.Min);
    const Vector max = this->Load(packet.Max);
    const Mask rays = GetBitMask(tag, there);
    for (int part = 0; part < this->Cell.Parts; ++part)
    {
      const std::uint8_t* const at = this->Cell.Tetrahedra[part];
      Found found;
      FindFaces(scale, seen[at[0]], seen[at[1]], seen[at[2]], seen[at[3]], rays, found);
      const Mask within = hn::And(hn::Ge(found.Exit, min), hn::Le(found.Enter, max));
      const std::uint32_t crossing = GetMaskBits(tag, hn::And(found.Twice, within));
      if (crossing != 0)
      {
        this->Write(found, crossing, part);
      }
    }
  }

  /// Lanes of which not all corners are on one side.
  HWY_INLINE std::uint32_t FindAround(const SeenPoint* seen) const
  {
    const D tag;
    const Vector infinity = hn::Set(tag, std::numeric_limits<double>::infinity());
    Vector least[2] = { infinity, infinity };
    Vector most[2] = { hn::Neg(infinity), hn::Neg(infinity) };
    for (int corner = 0; corner < this->Cell.Corners; ++corner)
    {
      least[0] = hn::Min(least[0], seen[corner].X);
      least[1] = hn::Min(least[1], seen[corner].Y);
      most[0] = hn::Max(most[0], seen[corner].X);
      most[1] = hn::Max(most[1], seen[corner].Y);
    }
    const Vector zero = hn::Zero(tag);
    return GetMaskBits(tag,
      hn::And(hn::Le(hn::Max(least[0], least[1]), zero), hn::Ge(hn::Min(most[0], most[1]), zero)));
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

  HWY_INLINE void Write(const Found& found, std::uint32_t crossing, int part)
  {
    const D tag;
    HWY_ALIGN double numbers[4][Width];
    hn::Store(found.Enter, tag, numbers[0]);
    hn::Store(found.Exit, tag, numbers[1]);
    hn::Store(found.First, tag, numbers[2]);
    hn::Store(found.Last, tag, numbers[3]);
    for (; crossing != 0; crossing &= crossing - 1)
    {
      const int lane = __builtin_ctz(crossing);
      *this->Next++ = { numbers[0][lane], numbers[1][lane], numbers[2][lane], numbers[3][lane],
        static_cast<std::uint8_t>(this->Lanes[lane]), static_cast<std::uint8_t>(part) };
    }
  }

  const CellPacket& Packet;
  const CellKernel::Cell& Cell;
  CellKernel::Crossing* Next = nullptr;
  HWY_ALIGN std::int64_t Lanes[Width]; ///< those of the packet that are looked at
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
