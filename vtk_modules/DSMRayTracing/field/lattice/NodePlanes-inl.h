// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_NodePlanes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_NodePlanes_inl_h
#undef rt_NodePlanes_inl_h
#else
#define rt_NodePlanes_inl_h
#endif

#include "DSMBricks/layout/GridPlanes.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/ray/RayPacket.h"

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Where the planes between cells are that BrickSearch names by their indices: at these, in a uniform lattice.
template <class D>
class UniformPlanes
{
public:
  using Vector = hn::Vec<D>;

  explicit UniformPlanes(const RayPacket& packet)
    : Forward(packet.Forward)
  {
  }

  /// Planes of a box of nodes of `edge` cells that rays come into through the planes `entry` (FindCrossedNodes).
  class Box
  {
  public:
    HWY_INLINE Box(const UniformPlanes& planes, const Vector entry[3], double edge)
      : Forward(planes.Forward)
      , Entry{ entry[0], entry[1], entry[2] }
      , Edge(edge)
    {
    }
    HWY_INLINE Vector operator()(int axis, int number) const
    {
      const double step = this->Forward[axis] ? this->Edge : -this->Edge;
      return number == 0 ? this->Entry[axis]
                         : hn::Add(this->Entry[axis], hn::Set(D(), number * step));
    }

  private:
    const bool* Forward;
    Vector Entry[3];
    double Edge;
  };

  /// Cells, each between two planes on an axis.
  struct Cell
  {
    Vector Lower;
    Vector Upper;

    HWY_INLINE Cell(const UniformPlanes&, int, Vector index)
      : Lower(index)
      , Upper(hn::Add(index, hn::Set(D(), 1.0)))
    {
    }
    /// Where in its cell a point is: from 0 to 1, but for rounding.
    HWY_INLINE Vector GetWithin(Vector point) const { return hn::Sub(point, this->Lower); }
  };

private:
  const bool* Forward;
};

/// The same in a rectilinear grid: looked up.
template <class D>
class StretchedPlanes
{
public:
  using Vector = hn::Vec<D>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(D()));

  explicit StretchedPlanes(const RayPacket& packet)
    : Forward(packet.Forward)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Places[axis] = packet.Planes->GetPlaces(axis);
      this->Inverse[axis] = packet.Planes->GetInverseWidths(axis);
    }
  }

  class Box
  {
  public:
    HWY_INLINE Box(const StretchedPlanes& planes, const Vector entry[3], int edge)
      : Planes(planes)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        this->Step[axis] = planes.Forward[axis] ? edge : -edge;
        hn::Store(ToNumbers(entry[axis]), hn::RebindToUnsigned<D>(), this->Entry[axis]);
      }
    }
    HWY_INLINE Vector operator()(int axis, int number) const
    {
      const double* const places = this->Planes.Places[axis];
      const std::int64_t step = number * this->Step[axis];
      return SetLanes<double, Width>([&](int lane)
        { return places[static_cast<std::int64_t>(this->Entry[axis][lane]) + step]; });
    }

  private:
    const StretchedPlanes& Planes;
    std::int64_t Step[3];
    HWY_ALIGN std::uint64_t Entry[3][Width];
  };

  struct Cell
  {
    Vector Lower;
    Vector Upper;
    Vector Inverse;

    HWY_INLINE Cell(const StretchedPlanes& planes, int axis, Vector index)
    {
      HWY_ALIGN std::uint64_t at[Width];
      hn::Store(ToNumbers(index), hn::RebindToUnsigned<D>(), at);
      const double* const places = planes.Places[axis];
      const double* const inverse = planes.Inverse[axis];
      this->Lower = SetLanes<double, Width>([&](int lane) { return places[at[lane]]; });
      this->Upper = SetLanes<double, Width>([&](int lane) { return places[at[lane] + 1]; });
      this->Inverse = SetLanes<double, Width>([&](int lane) { return inverse[at[lane]]; });
    }
    HWY_INLINE Vector GetWithin(Vector point) const
    {
      return hn::Mul(hn::Sub(point, this->Lower), this->Inverse);
    }
  };

private:
  const bool* Forward;
  const double* Places[3];
  const double* Inverse[3];
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
