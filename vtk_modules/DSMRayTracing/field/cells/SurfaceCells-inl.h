// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_SurfaceCells_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_SurfaceCells_inl_h
#undef rt_SurfaceCells_inl_h
#else
#define rt_SurfaceCells_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/base/VectorLanes-inl.h"
#include "DSMRayTracing/field/cells/Cubics-inl.h"
#include "DSMRayTracing/ray/RayMask.h"

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Rays that meet the surface in a cell, one after the other as they are found, before it is known where in the cell.
/// `PlaceNumbers`: that of CellCrossing.
template <int PlaceNumbers>
struct FoundCrossings
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
    Place, ///< PlaceNumbers
    Numbers = Place + PlaceNumbers
  };

  /// Numbers of the rays in a vector.
  template <class D>
  struct Vectors
  {
    HWY_ALIGN double Values[Numbers][hn::MaxLanes(D())];

    HWY_INLINE void Put(int number, hn::Vec<D> value)
    {
      hn::Store(value, D(), this->Values[number]);
    }
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

  /// Finds where the crossings are, for a vector of them at a time: calls `take(first, t, position, isFromInside)`.
  /// `first`: the first one's index, `position`: on the ways in the cells, from 0 to 1; `isFromInside`: bits.
  template <class D, class Take>
  HWY_INLINE void Refine(D tag, const Take& take) const
  {
    using Vector = hn::Vec<D>;
    constexpr int width = static_cast<int>(hn::MaxLanes(D()));
    for (int first = 0; first < this->Count; first += width)
    {
      const auto load = [&](int number) { return hn::Load(tag, this->Values[number] + first); };
      const auto rays = hn::FirstN(tag, static_cast<std::size_t>(this->Count - first));
      Vector coefficients[4];
      for (int power = 0; power < 4; ++power)
      {
        coefficients[power] = load(Coefficients + power);
      }
      const Bracket<D> bracket{ load(BeginS), load(BeginValue), load(EndS), load(EndValue) };
      const Vector s = Cubics<D>(coefficients, coefficients[0]).Refine(rays, bracket);
      const Vector enter = load(Enter);
      const Vector leave = load(Leave);
      const Vector t = hn::Add(enter, hn::Mul(s, hn::Sub(leave, enter)));
      // Nothing changes its side before the bracket.
      take(first, hn::IfThenElse(hn::Lt(leave, t), leave, t), s,
        GetMaskBits(tag, hn::Ge(bracket.BeginValue, hn::Zero(tag))));
    }
  }

  /// A number of PutPlace, of crossing `first` and those after it.
  template <class D>
  HWY_INLINE hn::Vec<D> GetPlace(D tag, int number, int first) const
  {
    return hn::Load(tag, this->Values[Place + number] + first);
  }

  int Count = 0;
  int Ray[MaxRays];
  HWY_ALIGN double Values[Numbers][MaxRays];
};

/// Visitor for rays that end at their first crossing of the surface; see CellCrossing.
template <class D, int PlaceNumbers>
class FirstCrossings
{
public:
  using Found = FoundCrossings<PlaceNumbers>;

  /// `crossings` is null when only those rays that meet the surface are asked for, not where.
  explicit FirstCrossings(Found* crossings)
    : Crossings(crossings)
  {
  }

  template <class Crossing>
  HWY_INLINE std::uint32_t Visit(const Crossing& cells)
  {
    static_assert(Crossing::PlaceNumbers == PlaceNumbers, "other cells than those of the visitor");
    const D tag;
    const Cubics<D> cubics = cells.GetCubics();
    Bracket<D> bracket;
    std::uint32_t found = GetMaskBits(tag, cubics.FindFirst(cells.Crossing, bracket)) & cells.There;
    if (const std::uint32_t hidden = cells.FindHidden(cubics, cells.There & ~found))
    {
      EndThere(hidden, bracket);
      found |= hidden;
    }
    if (this->Crossings && found != 0)
    {
      typename Found::template Vectors<D> numbers;
      numbers.Put(Found::BeginS, bracket.BeginS);
      numbers.Put(Found::BeginValue, bracket.BeginValue);
      numbers.Put(Found::EndS, bracket.EndS);
      numbers.Put(Found::EndValue, bracket.EndValue);
      numbers.Put(Found::Enter, cells.Enter);
      numbers.Put(Found::Leave, cells.Exit);
      hn::Vec<D> coefficients[4];
      cubics.GetCoefficients(coefficients);
      for (int power = 0; power < 4; ++power)
      {
        numbers.Put(Found::Coefficients + power, coefficients[power]);
      }
      cells.PutPlace(
        [&](int number, hn::Vec<D> value) { numbers.Put(Found::Place + number, value); });
      this->Crossings->Add(found, cells.Ray, numbers);
    }
    return found;
  }

private:
  /// Puts the crossings of those rays (bits) to the ends of their ways.
  static void EndThere(std::uint32_t rays, Bracket<D>& bracket)
  {
    const D tag;
    const auto chosen = GetBitMask(tag, rays);
    const auto one = hn::Set(tag, 1.0);
    const auto isInside = hn::Ge(bracket.BeginValue, hn::Zero(tag));
    bracket.BeginS = hn::IfThenElse(chosen, one, bracket.BeginS);
    bracket.EndS = hn::IfThenElse(chosen, one, bracket.EndS);
    bracket.EndValue =
      hn::IfThenElse(chosen, hn::IfThenElse(isInside, hn::Neg(one), one), bracket.EndValue);
  }

  Found* Crossings;
};

/// Visitor for rays that pass through the surface: adds each ray's number of crossings to `counts`.
template <class D>
class CrossingCounts
{
public:
  explicit CrossingCounts(int* counts)
    : Counts(counts)
  {
  }

  template <class Crossing>
  HWY_INLINE std::uint32_t Visit(const Crossing& cells)
  {
    const Cubics<D> cubics = cells.GetCubics();
    HWY_ALIGN double numbers[hn::MaxLanes(D())];
    hn::Store(cubics.Count(cells.Crossing), D(), numbers);
    std::uint32_t uncrossed = 0;
    for (std::uint32_t left = cells.There; left != 0; left &= left - 1)
    {
      const int lane = __builtin_ctz(left);
      const int count = static_cast<int>(numbers[lane]);
      this->Counts[cells.Ray[lane]] += count;
      uncrossed |= std::uint32_t{ count == 0 } << lane;
    }
    for (std::uint32_t left = cells.FindHidden(cubics, uncrossed); left != 0; left &= left - 1)
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
