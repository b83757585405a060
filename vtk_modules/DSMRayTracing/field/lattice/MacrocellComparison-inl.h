// SPDX-License-Identifier: BSD-3-Clause
// Included once for each instruction set; see PacketKernel.cxx.
#if defined(rt_MacrocellComparison_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef rt_MacrocellComparison_inl_h
#undef rt_MacrocellComparison_inl_h
#else
#define rt_MacrocellComparison_inl_h
#endif

#include "DSMRayTracing/base/MaskBits-inl.h"
#include "DSMRayTracing/field/lattice/MacrocellKernel.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace rt
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// The functions of MacrocellComparison with vectors of at most `Lanes` samples.
template <class T, std::size_t Lanes>
class MacrocellComparisonSteps
{
public:
  static constexpr MacrocellComparison<T> Create() { return { &FindCells, &FindMacrocells }; }

private:
  static constexpr int Edge = MacrocellComparison<T>::Edge;
  static constexpr int RowSamples = MacrocellComparison<T>::RowSamples;

  /// Not so for what is not a number.
  template <class Vector>
  static auto IsInside(Vector samples, Vector first)
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      return hn::Ge(samples, first);
    }
    else
    {
      return hn::Not(hn::Lt(samples, first));
    }
  }

  /// Bits of the samples from `row` on that are inside: of RowSamples if a vector has room for these, else of five.
  static HWY_INLINE std::uint64_t CompareRow(const T* row, T first)
  {
    const hn::CappedTag<T, std::min<std::size_t>(Lanes, RowSamples)> tag;
    constexpr int width = static_cast<int>(hn::MaxLanes(tag));
    const auto level = hn::Set(tag, first);
    std::uint32_t inside = 0;
    for (int part = 0; part <= Edge; part += width)
    {
      const int begin = std::max(0, std::min(part, Edge + 1 - width));
      inside |= GetMaskBits(tag, IsInside(hn::LoadU(tag, row + begin), level)) << begin;
    }
    return inside;
  }

  static std::uint64_t FindCells(
    const T* samples, int x, std::ptrdiff_t row, std::ptrdiff_t slice, T first)
  {
    // Rows of samples are 8 bits apart. A cell has its corners at its own bit and the next one, and
    // at the same bits of the next row. Memory behind the last row may be invalid, so vectors end
    // with the row.
    const bool isWide =
      hn::MaxLanes(hn::CappedTag<T, std::min<std::size_t>(Lanes, RowSamples)>()) > Edge;
    const int begin = isWide ? std::min(x, static_cast<int>(row) - RowSamples) : x;
    const int shift = x - begin;
    std::uint64_t cells = 0;
    std::uint64_t lastAny = 0;
    std::uint64_t lastAll = 0;
    for (int z = 0; z <= Edge; ++z)
    {
      std::uint64_t inside = 0;
      for (int y = 0; y <= Edge; ++y)
      {
        inside |= CompareRow(samples + begin + y * row + z * slice, first) << (8 * y);
      }
      inside >>= shift;
      std::uint64_t any = inside | inside >> 1;
      std::uint64_t all = inside & inside >> 1;
      any |= any >> 8;
      all &= all >> 8;
      if (z > 0)
      {
        // Four bits of each of four bytes, side by side.
        std::uint64_t mixed = (any | lastAny) & ~(all & lastAll) & 0x0f0f0f0fu;
        mixed = (mixed | mixed >> 4) & 0x00ff00ffu;
        mixed = (mixed | mixed >> 8) & 0x0000ffffu;
        cells |= mixed << (16 * (z - 1));
      }
      lastAny = any;
      lastAll = all;
    }
    return cells;
  }

  static std::uint64_t FindMacrocells(
    const bricks::MacrocellRange<T>* ranges, std::ptrdiff_t row, std::ptrdiff_t slice, T first)
  {
    const hn::CappedTag<T, std::min<std::size_t>(Lanes, Edge)> tag;
    constexpr int width = static_cast<int>(hn::MaxLanes(tag));
    const auto level = hn::Set(tag, first);
    std::uint64_t found = 0;
    for (int number = 0; number < Edge * Edge; ++number)
    {
      const bricks::MacrocellRange<T>* const begin =
        ranges + number % Edge * row + number / Edge * slice;
      for (int x = 0; x < Edge; x += width)
      {
        hn::Vec<decltype(tag)> least;
        hn::Vec<decltype(tag)> most;
        hn::LoadInterleaved2(tag, &begin[x].Min, least, most);
        const auto separated = hn::And(hn::Lt(least, level), IsInside(most, level));
        found |= std::uint64_t{ GetMaskBits(tag, separated) } << (x + Edge * number);
      }
    }
    return found;
  }
};

} // namespace HWY_NAMESPACE
} // namespace rt
HWY_AFTER_NAMESPACE();

#endif
