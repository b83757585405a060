// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see MeshKernel.cxx.
#if defined(rt_MeshPacketTriangle_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MeshPacketTriangle_inl_h
#undef rt_MeshPacketTriangle_inl_h
#else
#define rt_MeshPacketTriangle_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/mesh/MeshPacket.h"
#include "DSMRayTracing/mesh/TriangleHit.h"

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// One triangle against those rays of a packet that move most along an axis. FloatTag: vectors of floats; doubles have
/// as many lanes as fit.
template <class FloatTag, int Axis>
class MeshPacketTriangle
{
public:
  using Mask = MeshPacket::Mask;
  static constexpr int Size = MeshPacket::Size;

  MeshPacketTriangle(const MeshPacket& packet, const float* a, const float* b, const float* c)
    : Packet(packet)
    , Corners{ a, b, c }
  {
  }

  /// TriangleFilter: returns the subset of `rays` that may hit the triangle.
  HWY_INLINE Mask FindCandidates(Mask rays) const
  {
    using Vector = hn::Vec<FloatTag>;
    constexpr int width = static_cast<int>(hn::MaxLanes(FloatTag()));
    const FloatTag tag;
    Mask candidates = 0;
    for (int first = 0; first < Size; first += width)
    {
      if ((rays >> first & ((Mask{ 1 } << width) - 1)) == 0)
      {
        continue;
      }
      const Vector shearX = hn::Load(tag, this->Packet.FilterShear[0] + first);
      const Vector shearY = hn::Load(tag, this->Packet.FilterShear[1] + first);
      Vector x[3];
      Vector y[3];
      for (int corner = 0; corner < 3; ++corner)
      {
        Vector place[3];
        for (int number = 0; number < 3; ++number)
        {
          place[number] = hn::Sub(hn::Set(tag, this->Corners[corner][Axes[number]]),
            hn::Load(tag, this->Packet.Start[Axes[number]] + first));
        }
        x[corner] = hn::NegMulAdd(shearX, place[2], place[0]);
        y[corner] = hn::NegMulAdd(shearY, place[2], place[1]);
      }
      const Vector u = hn::MulSub(x[2], y[1], hn::Mul(y[2], x[1]));
      const Vector v = hn::MulSub(x[0], y[2], hn::Mul(y[0], x[2]));
      const Vector w = hn::MulSub(x[1], y[0], hn::Mul(y[1], x[0]));
      const Vector error = hn::Load(tag, this->Packet.FilterError + first);
      const auto misses = hn::And(hn::Lt(hn::Min(hn::Min(u, v), w), hn::Neg(error)),
        hn::Lt(error, hn::Max(hn::Max(u, v), w)));
      candidates |= static_cast<Mask>(GetMaskBits(tag, hn::Not(misses))) << first;
    }
    return candidates & rays;
  }

  /// IntersectTriangle: the same operations in the same order. Calls `take(ray, hit)` for each of `rays` that hits the
  /// triangle; `take` sets the brick and the triangle.
  template <class Take>
  HWY_INLINE void Intersect(Mask rays, const Take& take) const
  {
    using Tag = hn::CappedTag<double, (hn::MaxLanes(FloatTag()) + 1) / 2>;
    using Vector = hn::Vec<Tag>;
    constexpr int width = static_cast<int>(hn::MaxLanes(Tag()));
    const Tag tag;
    const Vector zero = hn::Zero(tag);
    for (int first = 0; first < Size; first += width)
    {
      const Mask some = rays >> first & ((Mask{ 1 } << width) - 1);
      if (some == 0)
      {
        continue;
      }
      const Vector shearX = hn::Load(tag, this->Packet.Shear[0] + first);
      const Vector shearY = hn::Load(tag, this->Packet.Shear[1] + first);
      // TriangleRay::SetAxes
      const auto turns = hn::Lt(hn::Load(tag, this->Packet.Shear[2] + first), zero);
      Vector x[3];
      Vector y[3];
      Vector z[3];
      for (int corner = 0; corner < 3; ++corner)
      {
        Vector place[3];
        for (int number = 0; number < 3; ++number)
        {
          place[number] = hn::Set(tag, double{ this->Corners[corner][Axes[number]] });
        }
        const Vector exchanged = hn::IfThenElse(turns, place[0], place[1]);
        place[0] = hn::IfThenElse(turns, place[1], place[0]);
        place[1] = exchanged;
        for (int number = 0; number < 3; ++number)
        {
          place[number] =
            hn::Sub(place[number], hn::Load(tag, this->Packet.Origin[number] + first));
        }
        z[corner] = place[2];
        x[corner] = hn::Sub(place[0], hn::Mul(shearX, place[2]));
        y[corner] = hn::Sub(place[1], hn::Mul(shearY, place[2]));
      }
      const Vector u = hn::Sub(hn::Mul(x[2], y[1]), hn::Mul(y[2], x[1]));
      const Vector v = hn::Sub(hn::Mul(x[0], y[2]), hn::Mul(y[0], x[2]));
      const Vector w = hn::Sub(hn::Mul(x[1], y[0]), hn::Mul(y[1], x[0]));
      const auto below = hn::Or(hn::Or(hn::Lt(u, zero), hn::Lt(v, zero)), hn::Lt(w, zero));
      const auto above = hn::Or(hn::Or(hn::Gt(u, zero), hn::Gt(v, zero)), hn::Gt(w, zero));
      const Vector determinant = hn::Add(hn::Add(u, v), w);
      const Vector inverse = hn::Div(hn::Set(tag, 1.0), determinant);
      const Vector sum = hn::Add(hn::Add(hn::Mul(u, z[0]), hn::Mul(v, z[1])), hn::Mul(w, z[2]));
      const Vector t = hn::Mul(hn::Mul(sum, inverse), hn::Load(tag, this->Packet.Shear[2] + first));
      const auto inside = hn::And(hn::Ge(t, hn::Load(tag, this->Packet.Min + first)),
        hn::Le(t, hn::Load(tag, this->Packet.Max + first)));
      const auto misses = hn::Or(hn::And(below, above), hn::Eq(determinant, zero));
      Mask hits = static_cast<Mask>(GetMaskBits(tag, hn::AndNot(misses, inside))) & some;
      if (hits == 0)
      {
        continue;
      }
      const auto fronts = static_cast<Mask>(GetMaskBits(tag, hn::Gt(determinant, zero)));
      HWY_ALIGN double distances[width];
      HWY_ALIGN double weights[3][width];
      hn::Store(t, tag, distances);
      hn::Store(hn::Mul(u, inverse), tag, weights[0]);
      hn::Store(hn::Mul(v, inverse), tag, weights[1]);
      hn::Store(hn::Mul(w, inverse), tag, weights[2]);
      for (; hits != 0; hits &= hits - 1)
      {
        const int lane = GetLowest(hits);
        TriangleHit hit;
        hit.T = distances[lane];
        hit.Front = (fronts >> lane & 1) != 0;
        for (int corner = 0; corner < 3; ++corner)
        {
          hit.Weights[corner] = weights[corner][lane];
          for (int axis = 0; axis < 3; ++axis)
          {
            hit.Corners[corner][axis] = this->Corners[corner][axis];
          }
        }
        take(first + lane, hit);
      }
    }
  }

private:
  static constexpr int Axes[3] = { (Axis + 1) % 3, (Axis + 2) % 3, Axis };

  const MeshPacket& Packet;
  const float* Corners[3];
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
