// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_BrickSamples_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_BrickSamples_inl_h
#undef rt_BrickSamples_inl_h
#else
#define rt_BrickSamples_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/lattice/MediumBrick.h"

#include <hwy/highway.h>

#include <cstdint>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// The values of a MediumBrick for a vector of rays: planes, cells, and the places of values in the transfer function.
/// Coordinates are those of the brick. `IsStretched`: in a rectilinear grid.
template <class F, bool IsStretched>
class BrickSamples
{
public:
  using Vector = hn::Vec<F>;
  using Mask = hn::Mask<F>;
  using NumberTag = hn::RebindToSigned<F>;
  using Numbers = hn::Vec<NumberTag>;
  static constexpr int Width = static_cast<int>(hn::MaxLanes(F()));

  /// Keeps a reference.
  explicit BrickSamples(const MediumBrick& brick)
    : Brick(brick)
  {
  }

  /// Where planes are, of the numbers that they have in the brick.
  HWY_INLINE Vector GetPlanes(int axis, Vector number) const
  {
    if constexpr (IsStretched)
    {
      return hn::GatherIndex(F(), this->Brick.Planes[axis], hn::ConvertTo(NumberTag(), number));
    }
    else
    {
      return number;
    }
  }
  /// The cells that points are in, out of those between two (of 2^steps).
  HWY_INLINE Vector FindCells(int axis, Vector point, Vector first, Vector last, int steps) const
  {
    const F tag;
    if constexpr (IsStretched)
    {
      Vector cell = first;
      for (int step = steps; step-- > 0;)
      {
        const Vector next =
          hn::Min(hn::Add(cell, hn::Set(tag, static_cast<float>(1 << step))), last);
        cell = hn::IfThenElse(hn::Le(this->GetPlanes(axis, next), point), next, cell);
      }
      return cell;
    }
    else
    {
      return hn::Min(hn::Max(hn::Floor(point), first), last);
    }
  }
  /// Steps of FindCells in a whole brick, and in a part.
  static constexpr int LargestSteps = 9;
  static constexpr int PartSteps = 5;

  /// Cells, and where points are in these.
  struct Places
  {
    Vector Cell[3];
    Vector Within[3];
  };
  /// Finds the places of points, in the cells from `low` to the planes `high`, which are in a part.
  HWY_INLINE Places FindPlaces(
    const Vector points[3], const Vector low[3], const Vector high[3]) const
  {
    const F tag;
    const Vector zero = hn::Zero(tag);
    const Vector one = hn::Set(tag, 1.0f);
    Places places;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vector point = points[axis];
      const Vector last = hn::Sub(high[axis], one);
      places.Cell[axis] = this->FindCells(axis, point, low[axis], last, PartSteps);
      Vector within = hn::Sub(point, this->GetPlanes(axis, places.Cell[axis]));
      if constexpr (IsStretched)
      {
        within = hn::Mul(within,
          hn::GatherIndex(
            tag, this->Brick.Inverse[axis], hn::ConvertTo(NumberTag(), places.Cell[axis])));
      }
      places.Within[axis] = hn::Min(hn::Max(within, zero), one);
    }
    return places;
  }

  /// Loads what Interpolate needs, at the corners of cells.
  HWY_INLINE void LoadCorners(const Vector cell[3], Vector corners[8]) const
  {
    this->template LoadSamples<4>(cell, corners);
  }
  HWY_INLINE Vector Interpolate(const Vector corners[8], const Vector within[3]) const
  {
    const auto mix = [](Vector a, Vector b, Vector part)
    { return hn::Add(a, hn::Mul(part, hn::Sub(b, a))); };
    const Vector front = mix(
      mix(corners[0], corners[1], within[0]), mix(corners[2], corners[3], within[0]), within[1]);
    const Vector back = mix(
      mix(corners[4], corners[5], within[0]), mix(corners[6], corners[7], within[0]), within[1]);
    return this->ToPlaces(mix(front, back, within[2]));
  }
  HWY_INLINE Vector FindValues(const Places& places) const
  {
    Vector corners[8];
    this->template LoadSamples<4>(places.Cell, corners);
    return this->Interpolate(corners, places.Within);
  }
  HWY_INLINE Vector FindNearest(const Vector cell[3]) const
  {
    const F tag;
    Vector place[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = hn::Floor(hn::Mul(hn::Add(cell[axis], hn::Set(tag, 1.0f)), hn::Set(tag, 0.5f)));
    }
    Vector sample;
    this->template LoadSamples<0>(place, &sample);
    return this->ToPlaces(sample);
  }

  /// Returns the subset of `rays` whose cells the mask lets hold data.
  HWY_NOINLINE Mask FindCovered(const Vector cell[3], Mask rays) const
  {
    const F tag;
    HWY_ALIGN float places[3][Width];
    for (int axis = 0; axis < 3; ++axis)
    {
      hn::Store(cell[axis], tag, places[axis]);
    }
    const int fine = this->Brick.IsNearest ? 2 : 1;
    std::uint32_t covered = 0;
    for (std::uint32_t left = GetMaskBits(tag, rays); left != 0; left &= left - 1)
    {
      const int lane = __builtin_ctz(left);
      const auto get = [&](int axis) { return static_cast<int>(places[axis][lane]) / fine; };
      const int number = get(0) + this->Brick.Cells[0] * (get(1) + this->Brick.Cells[1] * get(2));
      covered |= static_cast<std::uint32_t>(this->Brick.Mask[number >> 3] >> (number & 7) & 1)
        << lane;
    }
    return GetBitMask(tag, covered);
  }

private:
  /// Returns the places of values from which Subtracted is subtracted.
  Vector ToPlaces(Vector values) const
  {
    const F tag;
    return hn::Add(
      hn::Mul(values, hn::Set(tag, this->Brick.Scale)), hn::Set(tag, this->Brick.Offset));
  }

  /// Loads samples less Subtracted: at the corners of cells, in as many pairs on x, or at places themselves (no pairs).
  template <int Pairs>
  HWY_INLINE void LoadSamples(const Vector place[3], Vector* samples) const
  {
    const F tag;
    const Vector row = hn::Mul(place[1], hn::Set(tag, static_cast<float>(this->Brick.Row)));
    const Vector slice = hn::Mul(place[2], hn::Set(tag, static_cast<float>(this->Brick.Slice)));
    const Numbers offsets = hn::ConvertTo(NumberTag(), hn::Add(hn::Add(place[0], row), slice));
    switch (this->Brick.Kind)
    {
      case MediumBrick::SampleKind::Float:
        this->template LoadPairs<float, Pairs>(offsets, samples);
        break;
      case MediumBrick::SampleKind::SignedByte:
        this->template LoadPairs<std::int8_t, Pairs>(offsets, samples);
        break;
      case MediumBrick::SampleKind::Byte:
        this->template LoadPairs<std::uint8_t, Pairs>(offsets, samples);
        break;
      case MediumBrick::SampleKind::SignedShort:
        this->template LoadPairs<std::int16_t, Pairs>(offsets, samples);
        break;
      default:
        this->template LoadPairs<std::uint16_t, Pairs>(offsets, samples);
        break;
    }
  }
  template <class T, int Pairs>
  HWY_INLINE void LoadPairs(Numbers offsets, Vector* samples) const
  {
    const F tag;
    const Vector subtracted = hn::Set(tag, this->Brick.Subtracted);
    HWY_ALIGN std::int32_t stored[Width];
    hn::Store(offsets, NumberTag(), stored);
    for (int pair = 0; pair < (Pairs == 0 ? 1 : Pairs); ++pair)
    {
      const T* const first = static_cast<const T*>(this->Brick.Samples) +
        (pair & 1) * this->Brick.Row + (pair >> 1) * this->Brick.Slice;
      Vector own[2];
      if constexpr (std::is_same_v<T, float> && Pairs != 0)
      {
        GatherPairs<F>(first, offsets, own[0], own[1]);
      }
      else
      {
        for (int side = 0; side < (Pairs == 0 ? 1 : 2); ++side)
        {
          if constexpr (std::is_same_v<T, float>)
          {
            own[side] = hn::GatherIndex(tag, first + side, offsets);
          }
          else
          {
            own[side] = hn::ConvertTo(tag,
              SetLanes<std::int32_t, Width>(
                [&](int lane) { return std::int32_t{ first[stored[lane] + side] }; }));
          }
        }
      }
      for (int side = 0; side < (Pairs == 0 ? 1 : 2); ++side)
      {
        samples[(Pairs == 0 ? 1 : 2) * pair + side] = hn::Sub(own[side], subtracted);
      }
    }
  }

  const MediumBrick& Brick;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
