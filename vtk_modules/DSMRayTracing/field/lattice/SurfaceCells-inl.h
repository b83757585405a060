// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_SurfaceCells_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_SurfaceCells_inl_h
#undef rt_SurfaceCells_inl_h
#else
#define rt_SurfaceCells_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/field/lattice/BrickSearch-inl.h"
#include "DSMRayTracing/field/lattice/PacketCrossing-inl.h"
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

/// Rays that meet the surface in a cell, one after the other as they are found, before it is known
/// where in the cell.
struct CellCrossings
{
  /// Names of the numbers of a crossing.
  enum Number
  {
    Coefficients = 0, ///< 4
    BeginS = 4,
    BeginValue,
    EndS,
    EndValue,
    Enter, ///< T at which the ray enters the cell
    Leave,
    Start, ///< 3
    Way = Start + 3,
    Cell = Way + 3, ///< position in the brick
    Numbers = Cell + 3
  };

  /// Numbers of the rays in a vector.
  template <class D>
  struct Vectors
  {
    HWY_ALIGN double Values[Numbers][hn::MaxLanes(D())];

    void Put(int number, hn::Vec<D> value) { hn::Store(value, D(), this->Values[number]); }
  };

  /// Adds those of a vector's rays that are `found` (bits).
  template <class D>
  HWY_INLINE void Add(std::uint32_t found, const std::size_t* rays, const Vectors<D>& from)
  {
    for (; found != 0; found &= found - 1)
    {
      const int lane = __builtin_ctz(found);
      this->Ray[this->Count] = static_cast<int>(rays[lane]);
      for (int number = 0; number < Numbers; ++number)
      {
        this->Values[number][this->Count] = from.Values[number][lane];
      }
      ++this->Count;
    }
  }

  int Count = 0;
  int Ray[RayPacket::Size];
  HWY_ALIGN double Values[Numbers][RayPacket::Size];
};

/// Returns which of a vector's `rays` (bits), none of which crosses the surface in its cell, may cross it where
/// they leave their cells: see PacketBrick::LevelBorder.
template <class D>
HWY_INLINE std::uint32_t FindHidden(
  const CrossedCells<D>& cells, const PacketCrossing<D>& crossing, std::uint32_t rays)
{
  const D tag;
  const PacketBrick::LevelBorder& border = cells.Brick->Border;
  if (border.Sides == 0)
  {
    return 0;
  }
  const auto isNear =
    hn::Le(hn::Abs(crossing.GetLast()), hn::Set(tag, border.Rounding * border.Largest));
  std::uint32_t near = GetMaskBits(tag, hn::And(isNear, cells.Crossing)) & rays;
  if (near == 0)
  {
    return 0;
  }
  HWY_ALIGN double values[8 + 3 + 3 + 1][hn::MaxLanes(tag)];
  for (int corner = 0; corner < 8; ++corner)
  {
    hn::Store(cells.Corners[corner], tag, values[corner]);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    hn::Store(cells.Place[axis], tag, values[8 + axis]);
    hn::Store(cells.End[axis], tag, values[11 + axis]);
  }
  hn::Store(crossing.GetLast(), tag, values[14]);
  std::uint32_t hidden = 0;
  for (; near != 0; near &= near - 1)
  {
    const int lane = __builtin_ctz(near);
    double corners[8];
    for (int corner = 0; corner < 8; ++corner)
    {
      corners[corner] = values[corner][lane];
    }
    int cell[3];
    double end[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      cell[axis] = static_cast<int>(values[8 + axis][lane]);
      end[axis] = values[11 + axis][lane];
    }
    const bool isHidden =
      border.MayHide(*cells.Brick, corners, cell, end, cells.Forward, values[14][lane]);
    hidden |= std::uint32_t{ isHidden } << lane;
  }
  return hidden;
}

/// Visitor for BrickSearch, for rays that end at their first crossing of the surface.
template <class D>
class FirstCrossings
{
public:
  static constexpr bool TakesMacrocells = false;

  /// `crossings` is null when only those rays that meet the surface are asked for, not where.
  explicit FirstCrossings(CellCrossings* crossings)
    : Crossings(crossings)
  {
  }

  HWY_INLINE std::uint32_t Visit(const CrossedCells<D>& cells)
  {
    const PacketCrossing<D> crossing(D(), cells.Corners, cells.Start, cells.End);
    Bracket<D> bracket;
    std::uint32_t found =
      GetMaskBits(D(), crossing.FindFirst(cells.Crossing, bracket)) & cells.There;
    if (const std::uint32_t hidden = FindHidden(cells, crossing, cells.There & ~found))
    {
      this->EndThere(hidden, bracket);
      found |= hidden;
    }
    if (this->Crossings && found != 0)
    {
      CellCrossings::Vectors<D> numbers;
      numbers.Put(CellCrossings::BeginS, bracket.BeginS);
      numbers.Put(CellCrossings::BeginValue, bracket.BeginValue);
      numbers.Put(CellCrossings::EndS, bracket.EndS);
      numbers.Put(CellCrossings::EndValue, bracket.EndValue);
      numbers.Put(CellCrossings::Enter, cells.Enter);
      numbers.Put(CellCrossings::Leave, cells.Exit);
      hn::Vec<D> coefficients[4];
      crossing.GetCoefficients(coefficients);
      for (int power = 0; power < 4; ++power)
      {
        numbers.Put(CellCrossings::Coefficients + power, coefficients[power]);
      }
      for (int axis = 0; axis < 3; ++axis)
      {
        numbers.Put(CellCrossings::Start + axis, cells.Start[axis]);
        numbers.Put(CellCrossings::Way + axis, hn::Sub(cells.End[axis], cells.Start[axis]));
        numbers.Put(CellCrossings::Cell + axis, cells.Place[axis]);
      }
      this->Crossings->Add(found, cells.Ray, numbers);
    }
    return found;
  }

private:
  /// Puts the crossings of those rays (bits) to the ends of their ways.
  static void EndThere(std::uint32_t rays, Bracket<D>& bracket)
  {
    const D tag;
    const std::uint8_t bits[8] = { static_cast<std::uint8_t>(rays) };
    const auto chosen = hn::LoadMaskBits(tag, bits);
    const auto one = hn::Set(tag, 1.0);
    const auto isInside = hn::Ge(bracket.BeginValue, hn::Zero(tag));
    bracket.BeginS = hn::IfThenElse(chosen, one, bracket.BeginS);
    bracket.EndS = hn::IfThenElse(chosen, one, bracket.EndS);
    bracket.EndValue =
      hn::IfThenElse(chosen, hn::IfThenElse(isInside, hn::Neg(one), one), bracket.EndValue);
  }

  CellCrossings* Crossings;
};

/// Visitor for BrickSearch, for rays that pass through the surface: adds each ray's number of
/// crossings to `counts`.
template <class D>
class CrossingCounts
{
public:
  static constexpr bool TakesMacrocells = false;

  explicit CrossingCounts(int* counts)
    : Counts(counts)
  {
  }

  HWY_INLINE std::uint32_t Visit(const CrossedCells<D>& cells)
  {
    const PacketCrossing<D> crossing(D(), cells.Corners, cells.Start, cells.End);
    HWY_ALIGN double numbers[hn::MaxLanes(D())];
    hn::Store(crossing.Count(cells.Crossing), D(), numbers);
    std::uint32_t uncrossed = 0;
    for (std::uint32_t left = cells.There; left != 0; left &= left - 1)
    {
      const int lane = __builtin_ctz(left);
      const int count = static_cast<int>(numbers[lane]);
      this->Counts[cells.Ray[lane]] += count;
      uncrossed |= std::uint32_t{ count == 0 } << lane;
    }
    for (std::uint32_t left = FindHidden(cells, crossing, uncrossed); left != 0; left &= left - 1)
    {
      ++this->Counts[cells.Ray[__builtin_ctz(left)]];
    }
    return 0;
  }

private:
  int* Counts;
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
